#include <fmt/format.h>

#include <algorithm>

#include "mien/report/detail/html.h"
#include "mien/report/detail/measure_joints.h"
#include "mien/report/detail/page.h"
#include "mien/report/detail/poses.h"

namespace mien::detail {
namespace {

constexpr int head_width = 380, head_height = 430, map_width = 340, map_height = 380;
constexpr int joint_width = 180, joint_height = 206;
/// The darkest colour of the distance map, percent of the face: the same on every report.
constexpr double distance_shown = 1;

std::vector<Marker> markers_at(const Character& character, const std::vector<Points>& posed,
                               const std::vector<LandmarkPoint>& landmarks) {
  std::vector<Marker> markers;
  for (const LandmarkPoint& landmark : landmarks) {
    const auto part = static_cast<std::size_t>(landmark.at.part);
    Marker marker;
    marker.position = position_of(character.parts[part].mesh, posed[part], landmark.at);
    markers.push_back(marker);
  }
  return markers;
}

RenderOptions with_map(RenderOptions options, std::vector<Eigen::VectorXf> values, double high,
                       const char* title) {
  VertexMap map;
  map.values = std::move(values);
  map.high = high;
  map.title = title;
  options.map = std::move(map);
  return options;
}

float largest(const std::vector<Eigen::VectorXf>& values) {
  float most = 0;
  for (const Eigen::VectorXf& part : values)
    if (part.size()) most = std::max(most, part.maxCoeff());
  return most;
}

std::string distance_maps(const PageInput& page) {
  const TransferReport& report = page.input.result.report;
  std::vector<Eigen::VectorXf> percent;
  for (const Eigen::VectorXf& part : report.distance) percent.push_back(100 * part);
  const RenderOptions options =
      with_map(sized(map_width, map_height), percent, distance_shown, "% of the face");
  const std::string caption = fmt::format(
      "<b>Guide to target.</b> Median {:.2f} %, 95 of 100 vertices below {:.2f} %, worst {:.1f} %.",
      100 * page.data.distance_median, 100 * page.data.distance_95, 100 * page.data.distance_worst);
  return figure(page.target.head(page.target.rest(), View::front, options), "distance from guide to target",
                caption) +
         figure(page.target.head(page.target.rest(), View::three_quarter, options),
                "distance from guide to target, three-quarter",
                "<b>Guide to target</b>, from the side. Dark: 1 % or more.");
}

std::string filled_map(const PageInput& page) {
  RenderOptions options = with_map(sized(map_width, map_height), page.input.result.report.filled, 1, "");
  options.map->colors = ColorMap::cool_warm;
  options.map->low = -1;
  options.map->legend = false;
  return figure(page.target.head(page.target.rest(), View::front, options), "vertices filled in from around",
                fmt::format("<b>Filled in.</b> Red: no trustworthy place on the source, {:.1f} % of the "
                            "vertices; motion comes from around.",
                            100 * page.data.filled_share));
}

std::string fold_maps(const PageInput& page) {
  if (page.data.shapes.empty()) return {};
  const double high =
      std::clamp(std::max(largest(page.data.folds), largest(page.data.thesis_folds)), 1.f, 4.f);
  const RenderOptions options = sized(map_width, map_height);
  std::string text = figure(
      page.target.face(page.target.rest(), with_map(options, page.data.folds, high, "shapes")), "folds",
      "<b>Folds.</b> In how many shapes a triangle turns over; most lie inside mouth, lids and nostrils.");
  if (page.data.thesis)
    text += figure(
        page.target.face(page.target.rest(), with_map(options, page.data.thesis_folds, high, "shapes")),
        "folds of the thesis's method", "<b>Folds by the thesis's method</b>, same colours.");
  return text;
}

}  // namespace

std::string surfaces_section(const PageInput& page) {
  const TransferReport& report = page.input.result.report;
  const Character &source = page.input.source, &target = page.input.result.character;
  std::string text =
      "<h2 id=\"surfaces\">Source, guide, target</h2>\n<p>The guide is the source brought onto the target: "
      "its triangles, the target's shape. Red dots are landmarks.</p>\n";
  for (const View view : {View::front, View::three_quarter}) {
    RenderOptions options = sized(head_width, head_height);
    text += "<div class=\"three\">\n";
    options.markers = markers_at(source, page.source.rest(), report.pairs.source);
    text += figure(page.source.head(page.source.rest(), view, options), "source", "<b>Source</b>");
    options.markers = markers_at(source, report.guide, report.pairs.source);
    text += figure(page.target.head(page.source.renderer(), report.guide, view, options), "guide",
                   "<b>Guide</b>");
    options.markers = markers_at(target, page.target.rest(), report.pairs.target);
    text +=
        figure(page.target.head(page.target.rest(), view, options), "target", "<b>Target</b>") + "</div>\n";
  }
  text += fmt::format("<p>At landmarks the guide is {:.2f} % of the face off on average",
                      100 * page.data.landmark_mean);
  if (!page.data.worst_landmark.empty())
    text += fmt::format(", {:.2f} % at worst ({})", 100 * page.data.landmark_worst,
                        escaped(page.data.worst_landmark));
  return text + ".</p>\n";
}

std::string maps_section(const PageInput& page) {
  return "<h2 id=\"maps\">Maps on the target</h2>\n<div class=\"maps\">\n" + distance_maps(page) +
         filled_map(page) + fold_maps(page) + "</div>\n";
}

std::string weights_section(const PageInput& page) {
  if (page.data.joints.empty()) return {};
  std::string text =
      "<h2 id=\"weights\">Skin weights</h2>\n<p>The joints that hold most of the face; source left, target "
      "right. Shares are of all skin weight around the face.</p>\n<div class=\"cards\">\n";
  for (const JointRow& joint : page.data.joints) {
    const auto drawn = [&](const Portrait& portrait, const Character& character, int node) {
      return portrait.head(portrait.rest(), View::front,
                           with_map(sized(joint_width, joint_height), weight_map(character, node), 1, ""));
    };
    text += "<div class=\"card\"><div class=\"pair\">" +
            image(drawn(page.source, page.input.source, joint.source_joint), joint.name + " on the source") +
            image(drawn(page.target, page.input.result.character, joint.target_joint),
                  joint.name + " on the target") +
            "</div><h4>" + escaped(joint.name) + "</h4><p>" +
            fmt::format("share {:.1f} % / {:.1f} %", 100 * joint.source_share, 100 * joint.target_share) +
            "</p></div>\n";
  }
  return text + "</div>\n";
}

}  // namespace mien::detail
