// The same expressions on several faces in one picture: compare OUT.png EXPRESSION... -- FILE..., where an
// EXPRESSION is SHAPE, SHAPE+SHAPE or LABEL=SHAPE+SHAPE.

#include <algorithm>
#include <cstdio>
#include <fstream>
#include <string>
#include <vector>

#include "mien/character/landmark_points.h"
#include "mien/core/error.h"
#include "mien/evaluate/evaluate.h"
#include "mien/geometry/similarity.h"
#include "mien/io/load.h"
#include "mien/picture/render.h"
#include "mien/picture/sheet.h"

namespace {

/// "jawOpen+tongueOut" as a pose with those shapes at weight 1; shapes that the face does not have are left out.
mien::Pose pose_of(const mien::Character& face, std::string expression) {
  expression.erase(0, expression.find('=') + 1);
  mien::Pose pose = mien::rest_pose(face);
  for (std::size_t begin = 0; begin <= expression.size();) {
    const std::size_t end = std::min(expression.find('+', begin), expression.size());
    const int shape = mien::find_shape(face, expression.substr(begin, end - begin));
    if (shape >= 0) pose.shape_weights.values[shape] = 1;
    begin = end + 1;
  }
  return pose;
}

/// The rotation that turns `face` the way the first face looks, by the landmarks that both have.
Eigen::Matrix3d facing_like(const mien::Character& first, const mien::Character& face) {
  std::vector<Eigen::Vector3d> here, there;
  for (const mien::LandmarkPoint& a : mien::landmark_points(face))
    for (const mien::LandmarkPoint& b : mien::landmark_points(first))
      if (a.name == b.name) here.push_back(a.position), there.push_back(b.position);
  mien::PointsD from(here.size(), 3), to(there.size(), 3);
  for (std::size_t i = 0; i < here.size(); ++i) {
    from.row(static_cast<Eigen::Index>(i)) = here[i];
    to.row(static_cast<Eigen::Index>(i)) = there[i];
  }
  return here.size() < 3 ? Eigen::Matrix3d::Identity() : mien::fit_similarity(from, to).rotation;
}

void compare(const std::string& out, const std::vector<std::string>& expressions,
             const std::vector<std::string>& files) {
  std::vector<mien::SheetCell> cells;
  mien::Character first;
  for (const std::string& file : files) {
    const mien::Character face = mien::load(file);
    if (cells.empty()) first = face;
    mien::FrameOptions frame;
    frame.facing = facing_like(first, face);
    mien::RenderOptions options;
    options.width = options.height = 240;
    options.camera = mien::frame_head(face, mien::evaluate(face, mien::rest_pose(face)), frame);
    const mien::Renderer renderer(face);
    for (const std::string& expression : expressions) {
      const mien::Picture picture = renderer.render(mien::evaluate(face, pose_of(face, expression)), options);
      cells.push_back({expression.substr(0, expression.find('=')), picture, {}});
    }
  }
  mien::SheetOptions sheet;
  sheet.columns = static_cast<int>(expressions.size());
  const std::vector<unsigned char> png = mien::encode_png(mien::contact_sheet(cells, sheet));
  std::ofstream stream(out, std::ios::binary);
  stream.write(reinterpret_cast<const char*>(png.data()), static_cast<std::streamsize>(png.size()));
  if (!stream.flush()) throw mien::io_error(out, "cannot be written", "a place that exists");
  std::printf("%s: %zu faces, %zu expressions\n", out.c_str(), files.size(), expressions.size());
}

}  // namespace

int main(int argc, char** argv) {
  std::vector<std::string> expressions, files;
  bool after_dashes = false;
  for (int i = 2; i < argc; ++i) {
    const std::string word = argv[i];
    if (word == "--")
      after_dashes = true;
    else
      (after_dashes ? files : expressions).push_back(word);
  }
  if (expressions.empty() || files.empty()) {
    std::fprintf(stderr, "usage: compare OUT.png [LABEL=]SHAPE[+SHAPE]... -- FILE...\n");
    return 2;
  }
  try {
    compare(argv[1], expressions, files);
    return 0;
  } catch (const mien::Error& error) {
    std::fprintf(stderr, "compare: %s\n", error.what());
    return 1;
  }
}
