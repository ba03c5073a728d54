// The figures of the wires' paper on a face of yours: wires OUT.png FIGURE FACE [LANDMARKS], where FIGURE is base, rebuilt, edited, blend
// or functions.

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <string>
#include <vector>

#include "mien/character/landmark_points.h"
#include "mien/core/error.h"
#include "mien/evaluate/evaluate.h"
#include "mien/extract/blend.h"
#include "mien/extract/draw_wires.h"
#include "mien/extract/edit_wires.h"
#include "mien/extract/extract_wires.h"
#include "mien/extract/improve_wires.h"
#include "mien/io/landmark_file.h"
#include "mien/io/load.h"
#include "mien/picture/plot.h"
#include "mien/picture/render.h"
#include "mien/picture/sheet.h"

namespace {

using Weights = std::vector<std::pair<std::string, double>>;

const Weights sad{{"browInnerUp", 0.9}, {"mouthFrown", 0.9}, {"mouthShrugLower", 0.4}, {"eyeSquint", 0.3}};
const Weights happy{{"mouthSmile", 0.9}, {"cheekSquint", 0.7}, {"eyeSquint", 0.4}, {"jawOpen", 0.15}};
const Weights surprised{{"browInnerUp", 0.8}, {"browOuterUp", 0.9}, {"eyeWide", 1}, {"jawOpen", 0.55}};
const Weights angry{{"browDown", 1}, {"noseSneer", 0.6}, {"mouthPress", 0.6}, {"mouthFrown", 0.4}};
const Weights asleep{{"eyeBlink", 1}, {"browInnerUp", 0.3}, {"mouthFrown", 0.3}};

/// The face and its wires, drawn through its landmarks where it has none yet.
mien::ExtractResult wires_of(const mien::Character& face) {
  std::vector<mien::Wire> wires = face.wires;
  mien::ExtractOptions options;
  options.residual = 1;  // of the face's box: nothing is kept beside the wires
  if (wires.empty()) wires = mien::draw_wires(face, mien::face_wire_sketches(face));
  options.solver.vertex_weights = mien::outer_vertex_weights(face, wires);
  if (face.wires.empty()) {
    mien::ImproveOptions improve;
    improve.solver = options.solver;
    wires = mien::improve_wires(face, wires, improve).wires;
  }
  return mien::extract_wires(face, wires, options);
}

/// A sheet in the making: every picture has the same camera.
class Figure {
 public:
  Figure(mien::Character face, int width, int height)
      : face_(std::move(face)), alone_(wires_of(face_).character), renderer_(face_) {
    options_.width = width;
    options_.height = height;
    options_.zoom = around_wires();
  }

  const mien::Character& face() const { return face_; }
  /// The same face as its wires alone move it.
  const mien::Character& alone() const { return alone_; }

  /// Shape weights of names like "mouthSmile", which stand for both sides.
  mien::ShapeWeights weights(const Weights& named) const {
    mien::ShapeWeights result(face_.shapes.size());
    for (const auto& [name, value] : named) {
      bool found = false;
      for (const char* end : {"", "_L", "_R", "Left", "Right"})
        if (const int shape = mien::find_shape(face_, name + end); shape >= 0) {
          result.values[shape] = value;
          found = true;
        }
      if (!found)
        throw mien::invalid_input("shape " + name, "the face has none of that name",
                                  "a face with ARKit's names");
    }
    return result;
  }

  /// Where the wires are in an expression: their curves, moved.
  std::vector<mien::Polyline> curves(const mien::Pose& pose) const {
    const std::vector<std::string> features = mien::wire_features(alone_);
    std::vector<mien::WireMove> moves = pose.wires;
    for (std::size_t s = 0; s < alone_.shapes.size(); ++s)
      for (mien::WireMove move : alone_.shapes[s].wires) {
        move.controls *= pose.shape_weights.values[static_cast<Eigen::Index>(s)];
        moves.push_back(move);
      }
    std::vector<mien::Polyline> lines;
    for (std::size_t w = 0; w < alone_.wires.size(); ++w) {
      const mien::Wire& wire = alone_.wires[w];
      mien::BSpline curve = wire.curve;
      for (const mien::WireMove& move : moves)
        if (move.wire == static_cast<int>(w) && move.controls.rows() > 0) curve.controls += move.controls;
      const auto feature = std::find(features.begin(), features.end(), wire.feature) - features.begin();
      lines.push_back({{}, colors[static_cast<std::size_t>(feature) % std::size(colors)]});
      for (int i = 0; i <= 40; ++i)
        lines.back().points.push_back(
            mien::point_at(curve, curve.low() + (curve.high() - curve.low()) * i / 40));
    }
    return lines;
  }

  void add(const mien::Character& character, const mien::Pose& pose, const std::string& label,
           bool with_curves = false) {
    mien::RenderOptions options = options_;
    if (with_curves) options.polylines = curves(pose);
    cells_.push_back({label, renderer_.render(mien::evaluate(character, pose), options), ""});
  }

  mien::Pose pose(const Weights& named) const {
    mien::Pose pose = mien::rest_pose(face_);
    pose.shape_weights = weights(named);
    return pose;
  }

  mien::Picture sheet(const std::string& title, int columns) const {
    mien::SheetOptions options;
    options.title = title;
    options.columns = columns;
    return mien::contact_sheet(cells_, options);
  }

 private:
  /// The box of the wires, and some room: the face without the neck.
  mien::Box around_wires() const {
    mien::PointsD points(0, 3);
    for (const mien::Wire& wire : alone_.wires) {
      points.conservativeResize(points.rows() + wire.curve.control_count(), Eigen::NoChange);
      points.bottomRows(wire.curve.control_count()) = wire.curve.controls;
    }
    const Eigen::Vector3d low = points.colwise().minCoeff(), high = points.colwise().maxCoeff();
    const Eigen::Vector3d room = Eigen::Vector3d(0.05, 0.1, 0).cwiseProduct(high - low);
    return {low - room, high + room};
  }

  static constexpr mien::Color colors[] = {{0.12f, 0.42f, 0.75f}, {0.85f, 0.25f, 0.1f}, {0.1f, 0.55f, 0.25f},
                                           {0.55f, 0.2f, 0.65f},  {0.8f, 0.55f, 0.05f}, {0.1f, 0.55f, 0.6f}};
  mien::Character face_, alone_;
  mien::Renderer renderer_;
  mien::RenderOptions options_;
  std::vector<mien::SheetCell> cells_;
};

/// Fig. 1: the base face and its reference curves.
mien::Picture base(mien::Character face) {
  Figure figure(std::move(face), 420, 480);
  figure.add(figure.face(), figure.pose({}), "the face");
  figure.add(figure.face(), figure.pose({}), "and its wires", true);
  return figure.sheet("Reference curves", 2);
}

/// Fig. 2: expressions, and what their wires alone make of them.
mien::Picture rebuilt(mien::Character face) {
  Figure figure(std::move(face), 260, 300);
  const std::pair<const char*, const Weights*> expressions[] = {
      {"sad", &sad}, {"happy", &happy}, {"surprised", &surprised}, {"angry", &angry}};
  for (const auto& [name, weights] : expressions) figure.add(figure.face(), figure.pose(*weights), name);
  for (const auto& [name, weights] : expressions)
    figure.add(figure.alone(), figure.pose(*weights), std::string("by its wires"));
  return figure.sheet("Expressions, and the same by their wires alone", 4);
}

/// A push of some wires: their control points move by `push` times a bump over the curve that is highest at `at`, 0 to 1.
void push(const mien::Character& face, const std::string& name, double at, const Eigen::Vector3d& push,
          mien::Pose& pose) {
  const int wire = mien::find_wire(face, name);
  if (wire < 0)
    throw mien::invalid_input("wire " + name, "the face has none of that name",
                              "wires through the landmarks");
  mien::WireMove move;
  move.wire = wire;
  const int count = face.wires[wire].curve.control_count();
  move.controls.resize(count, 3);
  for (int l = 0; l < count; ++l) {
    const double s = static_cast<double>(l) / (count - 1) - at;
    move.controls.row(l) = std::exp(-8 * s * s) * push.transpose();
  }
  pose.wires.push_back(move);
}

/// Fig. 3: a smile, edited at the lips, then at the brows.
mien::Picture edited(mien::Character face) {
  Figure figure(std::move(face), 300, 345);
  mien::Pose pose = figure.pose({{"mouthSmile", 0.7}});
  figure.add(figure.alone(), pose, "a smile and its wires", true);
  const double size = 0.01 * mien::bounding_box(figure.face().parts[0].mesh.positions).diagonal();
  for (const char* wire : {"lipUpperOuter", "lipUpperInner"})
    push(figure.alone(), wire, 0.5, size * Eigen::Vector3d(0, 0.8, 0.3), pose);
  for (const char* wire : {"lipLowerOuter", "lipLowerInner"})
    push(figure.alone(), wire, 0.5, size * Eigen::Vector3d(0, -2, 0.2), pose);
  figure.add(figure.alone(), pose, "its lips' wires moved", true);
  for (const char* wire : {"brow_L", "brow_R"})  // drawn from the temple to the nose
    push(figure.alone(), wire, 0.2, size * Eigen::Vector3d(0, 2, 0), pose);
  for (const char* wire : {"brow_L", "brow_R"})
    push(figure.alone(), wire, 1, size * Eigen::Vector3d(0, -1.2, 0.2), pose);
  figure.add(figure.alone(), pose, "then its brows' wires", true);
  return figure.sheet("An expression edited by its wires", 3);
}

/// Figs. 4 and 5: ten images from one expression to another, above at one pace, below eyes by sqrt t and mouth by t^3.
mien::Picture blended(mien::Character face, const Weights& from, const Weights& to,
                      const std::string& title) {
  constexpr int images = 10;
  Figure figure(std::move(face), 150, 172);
  for (const bool uniform : {true, false}) {
    mien::BlendOptions options;
    options.frames = images;
    if (!uniform)
      for (const std::string& feature : mien::wire_features(figure.alone())) {
        const bool upper = feature == "eyes" || feature == "brows";
        options.functions.push_back({feature, mien::blend_function(upper ? "sqrt" : "cube")});
      }
    const mien::Character clip =
        mien::blend(figure.alone(), figure.weights(from), figure.weights(to), options);
    for (int i = 0; i < images; ++i) {
      const double seconds = i / options.frames_per_second;
      figure.add(clip, mien::sample_clip(clip, clip.clips.back(), seconds),
                 (uniform ? "" : "by feature ") + std::string("(") + std::to_string(i + 1) + ")");
    }
  }
  return figure.sheet(title, images);
}

/// Fig. 6: the two blending functions.
mien::Picture functions() {
  mien::Series eyes{"eyes, sqrt t", {}, {}}, mouth{"mouth, t^3", {}, {}};
  for (int i = 0; i <= 100; ++i)
    for (auto [series, name] : {std::pair(&eyes, "sqrt"), std::pair(&mouth, "cube")}) {
      series->x.push_back(i / 100.0);
      series->y.push_back(mien::blend_function(name)(i / 100.0));
    }
  mien::PlotOptions options;
  options.title = "Blending functions";
  options.x_label = "t";
  options.y_label = "share of the second expression";
  options.width = 420;
  return mien::line_plot({eyes, mouth}, options);
}

mien::Picture draw(const std::string& name, mien::Character face) {
  if (name == "base") return base(std::move(face));
  if (name == "rebuilt") return rebuilt(std::move(face));
  if (name == "edited") return edited(std::move(face));
  if (name == "blend")
    return blended(std::move(face), happy, surprised,
                   "From happy to surprised: at one pace, and feature by feature");
  if (name == "blend2")
    return blended(std::move(face), angry, asleep,
                   "From angry to asleep: at one pace, and feature by feature");
  if (name == "functions") return functions();
  throw mien::invalid_input("figure " + name, "does not exist",
                            "base, rebuilt, edited, blend, blend2 or functions");
}

void write(const mien::Picture& picture, const std::string& file) {
  const auto png = mien::encode_png(picture);
  std::ofstream out(file, std::ios::binary);
  out.write(reinterpret_cast<const char*>(png.data()), static_cast<std::streamsize>(png.size()));
  if (!out.flush()) throw mien::io_error(file, "cannot be written", "a place that exists");
  std::printf("%s: %d x %d pixels\n", file.c_str(), picture.width, picture.height);
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 4 && argc != 5) {
    std::fprintf(stderr, "usage: wires OUT.png FIGURE FACE [LANDMARKS]\n");
    return 2;
  }
  try {
    mien::Character face = mien::load(argv[3]);
    if (argc == 5) face.landmarks = mien::read_landmarks(argv[4], face).landmarks;
    write(draw(argv[2], std::move(face)), argv[1]);
    return 0;
  } catch (const mien::Error& error) {
    std::fprintf(stderr, "wires: %s\n", error.what());
    return 1;
  }
}
