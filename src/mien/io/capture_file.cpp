#include "mien/io/capture_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <map>
#include <string>

#include "mien/core/error.h"
#include "mien/io/detail/csv.h"

namespace mien {
namespace {

using detail::CsvTable;
using detail::CsvTime;

/// A column that is one coordinate of a marker, axis 0, 1 or 2; -1: another column.
struct MarkerColumn {
  std::string marker;
  int axis = -1;
};

MarkerColumn marker_column(const std::string& name) {
  if (name.size() < 3) return {};
  const auto axis = std::string_view("xyz").find(static_cast<char>(std::tolower(name.back())));
  const char separator = name[name.size() - 2];
  if (axis == std::string_view::npos || std::string_view("._ :").find(separator) == std::string_view::npos)
    return {};
  return {name.substr(0, name.size() - 2), static_cast<int>(axis)};
}

bool holds_markers(const CsvTable& table) {
  const auto coordinates = std::count_if(table.names.begin(), table.names.end(), [](const std::string& name) {
    return marker_column(name).axis >= 0;
  });
  return coordinates >= 3 && 2 * coordinates > static_cast<std::ptrdiff_t>(table.names.size());
}

/// Columns that count rather than measure.
bool is_bookkeeping(const std::string& name) {
  return name == "BlendShapeCount" || name == "BlendshapeCount";
}

/// A slider that a frame leaves out keeps its last value; before its first it has that one.
void fill_gaps(Eigen::MatrixXd& values) {
  for (Eigen::Index c = 0; c < values.cols(); ++c) {
    double last = 0;
    for (Eigen::Index r = 0; r < values.rows(); ++r)
      if (std::isfinite(values(r, c))) {
        last = values(r, c);
        break;
      }
    for (Eigen::Index r = 0; r < values.rows(); ++r) {
      if (!std::isfinite(values(r, c))) values(r, c) = last;
      last = values(r, c);
    }
  }
}

SliderTake sliders_of(const CsvTable& table, double rate) {
  SliderTake take;
  const CsvTime time = detail::times_of(table, rate);
  take.seconds = time.seconds;
  std::vector<std::size_t> columns;
  for (std::size_t c = 0; c < table.names.size(); ++c)
    if (static_cast<int>(c) != time.column && !is_bookkeeping(table.names[c])) {
      columns.push_back(c);
      take.names.push_back(table.names[c]);
    }
  if (columns.empty()) throw io_error("header", "names no slider", "give one column a slider");
  take.values.resize(static_cast<Eigen::Index>(table.rows.size()), static_cast<Eigen::Index>(columns.size()));
  for (std::size_t r = 0; r < table.rows.size(); ++r)
    for (std::size_t c = 0; c < columns.size(); ++c)
      take.values(static_cast<Eigen::Index>(r), static_cast<Eigen::Index>(c)) =
          detail::number_in(table, r, columns[c]);
  fill_gaps(take.values);
  return take;
}

MarkerTake markers_of(const CsvTable& table, double rate) {
  MarkerTake take;
  take.seconds = detail::times_of(table, rate).seconds;
  std::map<std::string, std::array<int, 3>> columns;
  for (std::size_t c = 0; c < table.names.size(); ++c) {
    const MarkerColumn column = marker_column(table.names[c]);
    if (column.axis < 0) continue;
    auto [entry, is_new] = columns.try_emplace(column.marker, std::array<int, 3>{-1, -1, -1});
    if (is_new) take.names.push_back(column.marker);
    entry->second[static_cast<std::size_t>(column.axis)] = static_cast<int>(c);
  }
  for (const auto& [marker, axes] : columns)
    for (std::size_t axis = 0; axis < 3; ++axis)
      if (axes[axis] < 0)
        throw io_error(fmt::format("marker {}", marker.substr(0, 60)),
                       fmt::format("has no {} column", "xyz"[axis]), "give x, y and z of each marker");
  for (std::size_t r = 0; r < table.rows.size(); ++r) {
    PointsD positions = PointsD::Zero(static_cast<Eigen::Index>(take.names.size()), 3);
    std::vector<char> seen(take.names.size(), 1);
    for (std::size_t m = 0; m < take.names.size(); ++m)
      for (std::size_t axis = 0; axis < 3; ++axis) {
        const double value =
            detail::number_in(table, r, static_cast<std::size_t>(columns.at(take.names[m])[axis]));
        if (std::isfinite(value))
          positions(static_cast<Eigen::Index>(m), static_cast<Eigen::Index>(axis)) = value;
        else
          seen[m] = 0;
      }
    take.positions.push_back(std::move(positions));
    take.seen.push_back(std::move(seen));
  }
  return take;
}

void check_rate(double rate) {
  if (!(rate > 0) || !std::isfinite(rate))
    throw invalid_input("rate", fmt::format("is {}", rate), "give frames a second above 0");
}

}  // namespace

CaptureKind capture_kind(const std::filesystem::path& path) {
  std::string extension = path.extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  if (extension == ".bvh") return CaptureKind::skeleton;
  if (extension != ".csv")
    throw io_error("format", fmt::format("\"{}\" is not known", extension), "name a .csv or .bvh")
        .in_file(path.string());
  try {
    return holds_markers(detail::read_csv(path)) ? CaptureKind::markers : CaptureKind::sliders;
  } catch (const Error& error) {
    throw error.in_file(path.string());
  }
}

SliderTake read_slider_csv(const std::filesystem::path& path, double rate) {
  check_rate(rate);
  try {
    return sliders_of(detail::read_csv(path), rate);
  } catch (const Error& error) {
    throw error.in_file(path.string());
  }
}

MarkerTake read_marker_csv(const std::filesystem::path& path, double rate) {
  check_rate(rate);
  try {
    const CsvTable table = detail::read_csv(path);
    if (!holds_markers(table))
      throw io_error("header", "names no markers", "give columns NAME.x, NAME.y, NAME.z");
    return markers_of(table, rate);
  } catch (const Error& error) {
    throw error.in_file(path.string());
  }
}

}  // namespace mien
