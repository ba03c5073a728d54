// The two papers' figures on a face of yours: drag OUT.png FIGURE FACE, where FIGURE is haphazard, expressions, brow, corners or
// alpha.

#include <cstdio>
#include <fstream>
#include <limits>
#include <string>
#include <vector>

#include "mien/character/sliders.h"
#include "mien/core/error.h"
#include "mien/evaluate/evaluate.h"
#include "mien/io/load.h"
#include "mien/picture/render.h"
#include "mien/picture/sheet.h"
#include "mien/pose/attenuate.h"
#include "mien/pose/solve_pins.h"

namespace {

/// A face, its still camera, and the panels drawn so far.
class Figure {
 public:
  explicit Figure(const std::string& file) : face_(mien::load(file)), renderer_(face_) {
    options_.width = 300;
    options_.height = 360;
    options_.zoom = moved_box();
  }

  const mien::Character& face() const { return face_; }

  /// The slider `name_L` or `nameLeft`; side 0: `name` alone.
  int slider(const std::string& name, char side = 0) const {
    for (const std::string& end : side == 0     ? std::vector<std::string>{""}
                                  : side == 'L' ? std::vector<std::string>{"_L", "Left"}
                                                : std::vector<std::string>{"_R", "Right"})
      if (const int found = mien::find_slider(face_, name + end); found >= 0) return found;
    throw mien::invalid_input("slider " + name, "the face has none of that name",
                              "a face with ARKit's names");
  }

  void set(mien::RigPose& pose, const std::string& name, double value, bool both_sides = true) const {
    if (!both_sides) {
      pose.sliders.values[slider(name)] = value;
      return;
    }
    for (const char side : {'L', 'R'}) pose.sliders.values[slider(name, side)] = value;
  }

  mien::RigPose rest() const { return mien::rest_rig_pose(face_); }

  /// The vertex that a slider moves most.
  mien::SurfacePoint moved_most_by(int slider) const {
    mien::RigPose pose = rest();
    const auto from = mien::evaluate(face_, mien::pose_of(face_, pose));
    pose.sliders.values[slider] = 1;
    const auto to = mien::evaluate(face_, mien::pose_of(face_, pose));
    mien::SurfacePoint point;
    float most = -1;
    for (std::size_t p = 0; p < to.size(); ++p) {
      Eigen::Index vertex = 0;
      const float far = (to[p] - from[p]).rowwise().squaredNorm().maxCoeff(&vertex);
      if (far <= most) continue;
      most = far;
      point.part = static_cast<int>(p);
      point.vertex = static_cast<int>(vertex);
    }
    return point;
  }

  Eigen::Vector3d at(const mien::RigPose& pose, const mien::SurfacePoint& point) const {
    const auto posed = mien::evaluate(face_, mien::pose_of(face_, pose));
    return mien::position_of(face_.parts[point.part].mesh, posed[point.part], point);
  }

  double size() const { return mien::bounding_box(face_.parts[0].mesh.positions).diagonal(); }

  void add(const std::string& label, const std::string& caption, const mien::RigPose& pose,
           const std::vector<mien::SurfacePoint>& marked = {},
           const std::vector<Eigen::Vector3d>& goals = {}) {
    const auto posed = mien::evaluate(face_, mien::pose_of(face_, pose));
    mien::RenderOptions options = options_;
    for (const mien::SurfacePoint& point : marked)
      options.markers.push_back({mien::position_of(face_.parts[point.part].mesh, posed[point.part], point),
                                 "",
                                 {0.85f, 0.1f, 0.1f}});
    for (std::size_t g = 0; g < goals.size(); ++g) {
      options.markers.push_back({goals[g], "", {0.1f, 0.6f, 0.2f}});
      options.polylines.push_back({{options.markers[g].position, goals[g]}, {0.1f, 0.6f, 0.2f}});
    }
    cells_.push_back({label, renderer_.render(posed, options), caption});
  }

  void write(const std::string& file, const std::string& title) const {
    mien::SheetOptions sheet;
    sheet.title = title;
    sheet.columns = static_cast<int>(cells_.size());
    const auto png = mien::encode_png(mien::contact_sheet(cells_, sheet));
    std::ofstream out(file, std::ios::binary);
    out.write(reinterpret_cast<const char*>(png.data()), static_cast<std::streamsize>(png.size()));
    if (!out.flush()) throw mien::io_error(file, "cannot be written", "a place that exists");
    std::printf("%s: %zu panels\n", file.c_str(), cells_.size());
  }

 private:
  /// The box of what the mouth and the brows move: the face without the neck.
  mien::Box moved_box() const {
    std::vector<Eigen::Vector3d> moved;
    for (const char* name : {"browDown", "mouthSmile", "mouthFrown", "cheekPuff"})
      for (const char side : {'L', 'R'}) {
        const int found = mien::find_slider(face_, std::string(name) + (side == 'L' ? "_L" : "_R"));
        const int known =
            found >= 0 ? found
                       : mien::find_slider(face_, std::string(name) + (side == 'L' ? "Left" : "Right"));
        if (known >= 0) moved.push_back(at(rest(), moved_most_by(known)));
      }
    if (moved.empty())
      throw mien::invalid_input("face", "has no slider named like browDown", "a face with ARKit's names");
    mien::Box box{moved[0], moved[0]};
    for (const Eigen::Vector3d& point : moved) box = {box.low.cwiseMin(point), box.high.cwiseMax(point)};
    const Eigen::Vector3d room = Eigen::Vector3d(0.5, 0.45, 0.2).cwiseProduct(box.high - box.low);
    return {box.low - room, box.high + room};
  }

  mien::Character face_;
  mien::Renderer renderer_;
  mien::RenderOptions options_;
  std::vector<mien::SheetCell> cells_;
};

std::string number(const char* format, double value) {
  char text[64];
  std::snprintf(text, sizeof text, format, value);
  return text;
}

mien::Pin pin_on(const mien::SurfacePoint& point, const Eigen::Vector3d& goal) {
  mien::Pin pin;
  pin.at = point;
  pin.goal = goal;
  return pin;
}

/// Lewis and Anjyo 2010, Fig. 5: a drag to where the face cannot go.
void haphazard(Figure& figure) {
  const mien::SurfacePoint corner = figure.moved_most_by(figure.slider("mouthSmile", 'L'));
  const Eigen::Vector3d from = figure.at(figure.rest(), corner),
                        goal = from + figure.size() * Eigen::Vector3d(0.09, 0.05, 0.01);
  figure.add("at rest", "the pull", figure.rest(), {corner}, {goal});
  mien::SolvePinsOptions open;
  const double infinite = std::numeric_limits<double>::infinity();
  for (int s = 0; s < static_cast<int>(figure.face().sliders.size()); ++s)
    open.limits.push_back({s, -infinite, infinite});
  for (const bool bounded : {false, true}) {
    const auto result = mien::solve_pins(figure.face(), {pin_on(corner, goal)}, figure.rest(),
                                         bounded ? mien::SolvePinsOptions{} : open);
    const Eigen::VectorXd& w = result.pose.sliders.values;
    figure.add(bounded ? "within limits (eq. 3)" : "without limits (eq. 2)",
               number("sliders %.1f", w.minCoeff()) + number(" to %.1f", w.maxCoeff()), result.pose, {corner},
               {goal});
  }
}

/// Lewis and Anjyo 2010, Fig. 7: a local change on a blend of whole expressions.
void expressions(Figure& figure) {
  mien::RigPose ah = figure.rest(), oo = figure.rest(), blend = figure.rest();
  figure.set(ah, "jawOpen", 0.7, false);
  figure.set(oo, "mouthFunnel", 0.7, false);
  figure.set(oo, "mouthPucker", 0.6, false);
  figure.add("ah", "", ah);
  figure.add("oo", "", oo);
  blend.sliders.values = 0.5 * ah.sliders.values + 0.5 * oo.sliders.values;
  const mien::SurfacePoint corner = figure.moved_most_by(figure.slider("mouthSmile", 'L'));
  const Eigen::Vector3d goal = figure.at(blend, corner) + figure.size() * Eigen::Vector3d(0.008, 0.008, 0);
  figure.add("half of each", "the pull", blend, {corner}, {goal});
  mien::SolvePinsOptions soft;
  soft.rho = 0.02;  // near the blend rather than at the goal
  const auto result = mien::solve_pins(figure.face(), {pin_on(corner, goal)}, blend, soft);
  figure.add("pulled at one corner", std::to_string(result.moved.size()) + " sliders move", result.pose,
             {corner}, {goal});
}

mien::Tag tag_on(const mien::SurfacePoint& point, const char* axes) {
  return {point, mien::held_axes(axes)};
}

void add_attenuated(Figure& figure, const std::string& label, const std::vector<mien::Tag>& tags,
                    const mien::RigPose& tagging, const mien::RigPose& wished,
                    std::optional<double> alpha = {}) {
  mien::AttenuateOptions options;
  options.alpha = alpha;
  const auto result = mien::attenuate(figure.face(), tags, tagging, wished.sliders, options);
  mien::RigPose pose = wished;
  pose.sliders = result.sliders;
  std::vector<mien::SurfacePoint> points;
  for (const mien::Tag& tag : tags) points.push_back(tag.at);
  figure.add(label,
             number("alpha %.0f, ", result.alpha) + number("tagged move %.2f", result.drift) +
                 number(" for %.2f", result.unattenuated_drift),
             pose, points);
}

/// Lewis et al. 2005, Figs. 2 and 3: the brows are right; the mouth's sliders move them again.
void brow(Figure& figure) {
  mien::RigPose furrow = figure.rest();
  figure.set(furrow, "browDown", 0.4);
  mien::RigPose sneer = furrow;
  figure.set(sneer, "noseSneer", 1);
  figure.set(sneer, "mouthUpperUp", 0.7);
  figure.set(sneer, "cheekSquint", 0.7);
  const std::vector<mien::Tag> tags{tag_on(figure.moved_most_by(figure.slider("browDown", 'L')), "xyz"),
                                    tag_on(figure.moved_most_by(figure.slider("browDown", 'R')), "xyz")};
  figure.add("neutral", "", figure.rest());
  figure.add("browDown 0.4", "as wanted", furrow, {tags[0].at, tags[1].at});
  figure.add("then nose and mouth", "the brows go on", sneer, {tags[0].at, tags[1].at});
  add_attenuated(figure, "the same, attenuated", tags, furrow, sneer);
}

/// Lewis et al. 2005, Fig. 4: the corners of the mouth keep their height.
void corners(Figure& figure) {
  mien::RigPose smirk = figure.rest();
  figure.set(smirk, "mouthSmile", 0.7);
  const std::vector<mien::Tag> tags{tag_on(figure.moved_most_by(figure.slider("mouthSmile", 'L')), "y"),
                                    tag_on(figure.moved_most_by(figure.slider("mouthSmile", 'R')), "y")};
  figure.add("y of two vertices tagged", "", figure.rest(), {tags[0].at, tags[1].at});
  add_attenuated(figure, "mouthSmile 0.7, attenuated", tags, figure.rest(), smirk);
  figure.add("mouthSmile 0.7", "", smirk, {tags[0].at, tags[1].at});
}

/// Lewis et al. 2005, Fig. 5: vertices below the eye, three values of alpha.
void alpha(Figure& figure) {
  mien::RigPose wince = figure.rest();
  for (const char* name : {"cheekSquint", "noseSneer", "mouthUpperUp"}) figure.set(wince, name, 0.7);
  const mien::SurfacePoint below = figure.moved_most_by(figure.slider("cheekSquint", 'L'));
  const Eigen::Vector3d centre = figure.at(figure.rest(), below);
  const mien::Points& points = figure.face().parts[below.part].mesh.positions;
  std::vector<mien::Tag> tags;
  for (Eigen::Index v = 0; v < points.rows() && tags.size() < 6; ++v) {
    bool apart = (points.row(v).transpose().cast<double>() - centre).norm() < 0.035 * figure.size();
    for (const mien::Tag& tag : tags)
      apart = apart &&
              (points.row(v) - points.row(tag.at.vertex)).norm() > 0.016f * static_cast<float>(figure.size());
    mien::SurfacePoint point = below;
    point.vertex = static_cast<int>(v);
    if (apart) tags.push_back(tag_on(point, "xyz"));
  }
  std::vector<mien::SurfacePoint> marked;
  for (const mien::Tag& tag : tags) marked.push_back(tag.at);
  figure.add("six vertices tagged", "", figure.rest(), marked);
  figure.add("three sliders at 0.7", "not attenuated", wince, marked);
  add_attenuated(figure, "attenuated", tags, figure.rest(), wince);
  add_attenuated(figure, "a low alpha", tags, figure.rest(), wince, 25);
  add_attenuated(figure, "a high alpha", tags, figure.rest(), wince, 1e6);
}

void draw(const std::string& out, const std::string& name, const std::string& file) {
  struct Known {
    const char *name, *title;
    void (*draw)(Figure&);
  };
  const Known figures[] = {{"haphazard", "A drag out of reach", haphazard},
                           {"expressions", "A local change on whole expressions", expressions},
                           {"brow", "What was right stays right", brow},
                           {"corners", "One coordinate alone", corners},
                           {"alpha", "How still: alpha", alpha}};
  for (const Known& known : figures) {
    if (name != known.name) continue;
    Figure figure(file);
    known.draw(figure);
    figure.write(out, known.title);
    return;
  }
  throw mien::invalid_input("figure " + name, "does not exist",
                            "haphazard, expressions, brow, corners or alpha");
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 4) {
    std::fprintf(stderr, "usage: drag OUT.png FIGURE FACE\n");
    return 2;
  }
  try {
    draw(argv[1], argv[2], argv[3]);
    return 0;
  } catch (const mien::Error& error) {
    std::fprintf(stderr, "drag: %s\n", error.what());
    return 1;
  }
}
