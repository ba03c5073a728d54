#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "mien/report/detail/data.h"
#include "mien/report/thesis_times.h"

namespace mien::detail {
namespace {

using Json = nlohmann::ordered_json;

Json shapes_of(const Data& data) {
  Json rows = Json::array();
  for (const ShapeRow& shape : data.shapes) {
    Json row = {{"name", shape.name},
                {"moved", shape.moved},
                {"flips", {{"source", shape.source_flips}, {"target", shape.flips}}},
                {"worst_stretch", {{"source", shape.source_stretch}, {"target", shape.stretch}}}};
    if (data.thesis)
      row["thesis"] = {{"difference", shape.difference},
                       {"largest_difference", shape.largest_difference},
                       {"flips", shape.thesis_flips},
                       {"torn_edges", shape.thesis_torn}};
    rows.push_back(std::move(row));
  }
  return rows;
}

Json agreement_of(const CurveAgreement& agreement) {
  return {{"correlation", agreement.correlation},
          {"rms_difference", agreement.rms_difference},
          {"gain", agreement.gain}};
}

Json curves_of(const std::vector<CurveRow>& curves) {
  Json rows = Json::array();
  for (const CurveRow& curve : curves) {
    Json row = {{"between", curve.name},
                {"transferred", agreement_of(curve.target_agreement)},
                {"copied", agreement_of(curve.copied_agreement)},
                {"epsilon", {{"source", curve.source}, {"target", curve.target}}}};
    if (!curve.copied.empty()) row["epsilon"]["copied"] = curve.copied;
    rows.push_back(std::move(row));
  }
  return rows;
}

Json clips_of(const Data& data) {
  Json rows = Json::array();
  for (const ClipRows& clip : data.clips)
    rows.push_back({{"name", clip.name},
                    {"seconds", clip.seconds},
                    {"joints", curves_of(clip.joints)},
                    {"objects", curves_of(clip.objects)},
                    {"surface", curves_of(clip.surface)}});
  return rows;
}

Json seconds_of(const TransferReport& report) {
  Json steps = Json::object();
  for (const StepTime& step : report.steps) steps[step.step] = step.seconds;
  return steps;
}

Json thesis_seconds() {
  Json steps = Json::object();
  for (const ThesisStep& step : thesis_steps()) {
    Json row = Json::object();
    for (std::size_t c = 0; c < thesis_characters().size(); ++c)
      row[std::string(thesis_characters()[c].name)] = step.seconds[c];
    steps[std::string(step.name)] = std::move(row);
  }
  return steps;
}

}  // namespace

std::string as_json(const ReportInput& input, const Data& data) {
  const TransferReport& report = input.result.report;
  Json json = {{"source", input.source_name}, {"target", input.target_name}, {"output", input.output_name}};
  json["method"] = input.options.method == TransferMethod::thesis ? "thesis" : "register";
  json["landmarks"] = {{"count", report.pairs.names.size()},      {"mean_miss", data.landmark_mean},
                       {"worst_miss", data.landmark_worst},       {"worst", data.worst_landmark},
                       {"only_source", report.pairs.only_source}, {"only_target", report.pairs.only_target}};
  json["correspondence"] = name_of(report.correspondence);
  json["scale"] = report.similarity.scale;
  json["face_size"] = report.unit;
  json["guide_distance"] = {
      {"median", data.distance_median}, {"p95", data.distance_95}, {"worst", data.distance_worst}};
  json["filled_share"] = data.filled_share;
  json["deltas"] = {
      {"model", name_of(report.deltas.model)},          {"warp_share", report.deltas.warp_share},
      {"contact_ratio", report.deltas.contact_ratio},   {"stretch", report.deltas.stretch},
      {"contact_shapes", report.deltas.contact_shapes}, {"reason", report.deltas.reason}};
  json["shapes"] = shapes_of(data);
  if (data.thesis)
    json["thesis"] = {{"torn_share", data.torn_share}, {"seconds", seconds_of(data.thesis->report)}};
  else if (!data.thesis_problem.empty())
    json["thesis"] = {{"problem", data.thesis_problem}};
  json["joints"] = Json::array();
  for (const JointRow& joint : data.joints)
    json["joints"].push_back(
        {{"name", joint.name}, {"source_share", joint.source_share}, {"target_share", joint.target_share}});
  json["clips"] = clips_of(data);
  json["pieces"] = Json::array();
  for (const PieceReport& piece : report.pieces)
    json["pieces"].push_back({{"piece", piece.piece}, {"kind", piece.kind}, {"moves_with", piece.way}});
  json["warnings"] = Json::array();
  for (const TransferWarning& warning : report.warnings)
    json["warnings"].push_back({{"what", warning.what}, {"remedy", warning.remedy}});
  json["seconds"] = seconds_of(report);
  json["thesis_tables"] = thesis_seconds();
  return json.dump(1, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace mien::detail
