#pragma once
/// Comma-separated numbers below a header, as capture programs write them.

#include <filesystem>
#include <string>
#include <vector>

namespace mien::detail {

struct CsvTable {
  std::vector<std::string> names;              ///< the header's cells, trimmed
  std::vector<std::vector<std::string>> rows;  ///< each of names.size() trimmed cells
  std::vector<int> lines;                      ///< per row: its line in the file
};

/// Commas, semicolons or tabs, whichever the header has; quoted cells; comments (#) and blank lines are left out.
///   throws  io naming the line: no header, a row of another length, more than 10 million cells, two columns
///           of one name
CsvTable read_csv(const std::filesystem::path& path);

/// A finite number, or NaN for an empty cell or one that says NaN.
///   throws  io naming line and column: no number
double number_in(const CsvTable& table, std::size_t row, std::size_t column);

/// Which column tells the time, and each row's seconds from the first row's; times must ascend.
struct CsvTime {
  int column = -1;
  std::vector<double> seconds;
};
CsvTime times_of(const CsvTable& table, double rate);

}  // namespace mien::detail
