// Measure, draw, write. The pictures take most of the time: two a shape.
#include "mien/report/report.h"

#include <fmt/format.h>

#include <optional>

#include "mien/report/detail/data.h"
#include "mien/report/detail/html.h"
#include "mien/report/detail/page.h"
#include "mien/report/detail/portrait.h"

namespace mien {
namespace {

std::string page_of(const ReportInput& input, const detail::Data& data) {
  const TransferReport& report = input.result.report;
  // The source is seen as it stands; the target is turned the same way.
  const Eigen::Matrix3d facing = report.similarity.rotation.transpose();
  const detail::Portrait source(input.source, report.pairs.source, Eigen::Matrix3d::Identity());
  const detail::Portrait target(input.result.character, report.pairs.target, facing);
  std::optional<detail::Portrait> thesis;
  if (data.thesis) thesis.emplace(data.thesis->character, report.pairs.target, facing);
  const detail::PageInput page{input, data, source, target, thesis ? &*thesis : nullptr};
  std::string body;
  const auto add = [&](const char* step, double fraction, std::string (*section)(const detail::PageInput&)) {
    report_progress(input.progress, step, fraction);
    body += section(page);
  };
  add("report: surfaces", 0.3, detail::surfaces_section);
  add("report: maps", 0.35, detail::maps_section);
  add("report: shapes", 0.4, detail::shapes_section);
  add("report: thesis's method", 0.85, detail::baseline_section);
  add("report: skin weights", 0.9, detail::weights_section);
  add("report: curves", 0.97, detail::clips_section);
  add("report: pieces", 0.98, detail::pieces_section);
  add("report: seconds", 0.99, detail::seconds_section);
  return detail::document(input.source_name + " on " + input.target_name,
                          detail::overview_section(page, body) + body);
}

}  // namespace

Report make_report(const ReportInput& input) {
  const detail::Data data = detail::measure(input);
  Report report{page_of(input, data), detail::as_json(input, data)};
  report_progress(input.progress, "report", 1);
  return report;
}

}  // namespace mien
