#include "mien/io/detail/csv.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <cmath>
#include <limits>
#include <set>
#include <string_view>

#include "mien/core/error.h"
#include "mien/io/file.h"

namespace mien::detail {
namespace {

constexpr std::size_t most_cells = 10'000'000;

std::string_view trimmed(std::string_view text) {
  const auto is_blank = [](char c) { return std::isspace(static_cast<unsigned char>(c)) != 0; };
  while (!text.empty() && is_blank(text.front())) text.remove_prefix(1);
  while (!text.empty() && is_blank(text.back())) text.remove_suffix(1);
  return text;
}

std::vector<std::string> cells_of(std::string_view line, char separator) {
  std::vector<std::string> cells(1);
  bool quoted = false;
  for (const char c : line) {
    if (c == '"')
      quoted = !quoted;
    else if (c == separator && !quoted)
      cells.emplace_back();
    else
      cells.back() += c;
  }
  for (std::string& cell : cells) cell = trimmed(cell);
  return cells;
}

char separator_of(std::string_view header) {
  for (const char candidate : {',', ';', '\t'})
    if (header.find(candidate) != header.npos) return candidate;
  return ',';
}

std::string lower(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return text;
}

std::string place_of(const CsvTable& table, std::size_t row, std::size_t column) {
  return fmt::format("line {}, column {}", table.lines[row], table.names[column].substr(0, 60));
}

/// HH:MM:SS:FF.fff in seconds, with `base` frames a second.
double timecode_seconds(const CsvTable& table, std::size_t row, std::size_t column, double base) {
  std::array<double, 4> fields{};
  std::string_view text = table.rows[row][column];
  for (std::size_t k = 0; k < 4; ++k) {
    const std::size_t end = k < 3 ? text.find_first_of(":;") : text.size();
    const std::string_view field = text.substr(0, end);
    const auto [rest, failure] = std::from_chars(field.data(), field.data() + field.size(), fields[k]);
    if (end == text.npos || failure != std::errc() || rest != field.data() + field.size() || fields[k] < 0)
      throw io_error(place_of(table, row, column),
                     fmt::format("is \"{}\"", table.rows[row][column].substr(0, 40)),
                     "give a timecode HH:MM:SS:FF");
    text.remove_prefix(std::min(text.size(), end + 1));
  }
  return 3600 * fields[0] + 60 * fields[1] + fields[2] + fields[3] / base;
}

/// The frames a second that a timecode counts: the next usual rate above its largest frame number.
double timecode_base(const CsvTable& table, std::size_t column) {
  double largest = 0;
  for (const std::vector<std::string>& row : table.rows) {
    const std::string_view cell = row[column];
    const std::size_t colon = cell.find_last_of(":;");
    double frame = 0;
    if (colon != cell.npos) std::from_chars(cell.data() + colon + 1, cell.data() + cell.size(), frame);
    largest = std::max(largest, frame);
  }
  for (const double base : {24.0, 25.0, 30.0, 48.0, 50.0, 60.0, 100.0, 120.0})
    if (largest < base) return base;
  return 240;
}

void check_ascending(const CsvTable& table, CsvTime& time) {
  const double start = time.seconds.front();
  for (std::size_t row = 0; row < time.seconds.size(); ++row) {
    if (!std::isfinite(time.seconds[row]) ||
        (row > 0 && !(time.seconds[row] - start > time.seconds[row - 1])))
      throw io_error(
          place_of(table, row, static_cast<std::size_t>(time.column)),
          fmt::format("is \"{}\"", table.rows[row][static_cast<std::size_t>(time.column)].substr(0, 40)),
          "times must be later than the row's before");
    time.seconds[row] -= start;
  }
}

}  // namespace

CsvTable read_csv(const std::filesystem::path& path) {
  const std::vector<std::uint8_t> bytes = read_file(path);
  std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  if (text.starts_with("\xEF\xBB\xBF")) text.remove_prefix(3);
  CsvTable table;
  char separator = ',';
  std::size_t cells = 0;
  for (int line = 1; !text.empty(); ++line) {
    const std::size_t end = text.find('\n');
    const std::string_view whole = trimmed(text.substr(0, end));
    text.remove_prefix(end == text.npos ? text.size() : end + 1);
    if (whole.empty() || whole.front() == '#') continue;
    if (table.names.empty()) {
      separator = separator_of(whole);
      table.names = cells_of(whole, separator);
      continue;
    }
    std::vector<std::string> row = cells_of(whole, separator);
    if (row.size() != table.names.size())
      throw io_error(fmt::format("line {}", line), fmt::format("has {} cells", row.size()),
                     fmt::format("the header has {}", table.names.size()));
    cells += row.size();
    if (cells > most_cells)
      throw io_error(fmt::format("line {}", line), "is beyond 10 million cells", "cut the take");
    table.rows.push_back(std::move(row));
    table.lines.push_back(line);
  }
  if (table.rows.empty()) throw io_error("file", "has no rows", "give a header and one row a frame");
  std::set<std::string> seen;
  for (const std::string& name : table.names)
    if (!seen.insert(name).second)
      throw io_error("header", fmt::format("names {} twice", name.substr(0, 60)), "name each column once");
  return table;
}

double number_in(const CsvTable& table, std::size_t row, std::size_t column) {
  const std::string& cell = table.rows[row][column];
  if (cell.empty() || lower(cell) == "nan") return std::numeric_limits<double>::quiet_NaN();
  double value = 0;
  const auto [rest, failure] = std::from_chars(cell.data(), cell.data() + cell.size(), value);
  if (failure != std::errc() || rest != cell.data() + cell.size() || !std::isfinite(value))
    throw io_error(place_of(table, row, column), fmt::format("is \"{}\"", cell.substr(0, 40)),
                   "give a number");
  return value;
}

CsvTime times_of(const CsvTable& table, double rate) {
  CsvTime time;
  const std::string first = lower(table.names.front());
  const bool is_timecode = first == "timecode", is_frame = first == "frame" || first == "frames";
  const bool is_time = first == "time" || first == "seconds" || first == "time (s)" || first == "timestamp";
  if (!is_timecode && !is_frame && !is_time) {
    for (std::size_t row = 0; row < table.rows.size(); ++row)
      time.seconds.push_back(static_cast<double>(row) / rate);
    return time;
  }
  time.column = 0;
  const double base = is_timecode ? timecode_base(table, 0) : rate;
  for (std::size_t row = 0; row < table.rows.size(); ++row)
    time.seconds.push_back(is_timecode ? timecode_seconds(table, row, 0, base)
                           : is_frame  ? number_in(table, row, 0) / base
                                       : number_in(table, row, 0));
  check_ascending(table, time);
  return time;
}

}  // namespace mien::detail
