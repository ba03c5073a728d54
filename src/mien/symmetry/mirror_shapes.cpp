#include "mien/symmetry/mirror_shapes.h"

#include <algorithm>
#include <cmath>

#include "mien/character/sliders.h"
#include "mien/core/error.h"
#include "mien/geometry/surface_query.h"
#include "mien/naming/action.h"

namespace mien {
namespace {

constexpr double least_motion = 1e-6;  // of the box's diagonal: less is no displacement

std::string side_name(const std::string& name, Side side) {
  const bool underscores = name.find('_') != name.npos;
  return name + (underscores ? (side == Side::left ? "_L" : "_R") : (side == Side::left ? "Left" : "Right"));
}

/// The part's plane: model space where it has a skin or no node, else its node's space.
MirrorPlane plane_of_part(const MirrorPlane& plane, const Part& part,
                          const std::vector<Eigen::Matrix4d>& model) {
  if (part.skin >= 0 || part.node < 0) return plane;
  const Eigen::Matrix4d& matrix = model[static_cast<std::size_t>(part.node)];
  const Eigen::Vector3d across = matrix.topLeftCorner<3, 3>().transpose() * plane.normal;
  const double length = across.norm();
  return {across / length, (plane.offset - plane.normal.dot(matrix.topRightCorner<3, 1>())) / length};
}

double smooth_step(double t) {
  t = std::clamp(t, 0.0, 1.0);
  return t * t * (3 - 2 * t);
}

/// What of a displacement belongs to the left.
PartDelta share_of(const PartDelta& delta, const Part& part, const MirrorPlane& plane, Side side,
                   double width) {
  PartDelta kept;
  kept.part = delta.part;
  std::vector<Eigen::Index> rows;
  std::vector<float> shares;
  for (std::size_t k = 0; k < delta.vertices.size(); ++k) {
    const double at = plane.side(part.mesh.positions.row(delta.vertices[k]).cast<double>().transpose());
    const double left = smooth_step((at / width + 1) / 2);
    const double share = side == Side::left ? left : 1 - left;
    if (share == 0) continue;
    kept.vertices.push_back(delta.vertices[k]);
    rows.push_back(static_cast<Eigen::Index>(k));
    shares.push_back(static_cast<float>(share));
  }
  const Eigen::Map<const Eigen::VectorXf> factors(shares.data(), static_cast<Eigen::Index>(shares.size()));
  const auto scaled = [&](const Points& all) {
    return all.rows() == 0 ? Points(0, 3) : Points(factors.asDiagonal() * all(rows, Eigen::all));
  };
  kept.deltas = scaled(delta.deltas);
  kept.normal_deltas = scaled(delta.normal_deltas);
  kept.tangent_deltas = scaled(delta.tangent_deltas);
  return kept;
}

Shape side_of_shape(const Character& character, const Shape& shape, const MirrorPlane& plane, Side side,
                    double width) {
  const std::vector<Eigen::Matrix4d> model = model_matrices(character);
  Shape kept{side_name(shape.name, side), {}};
  for (const PartDelta& delta : shape.parts) {
    const Part& part = character.parts[static_cast<std::size_t>(delta.part)];
    const double length = width * bounding_box(part.mesh.positions).diagonal();
    kept.parts.push_back(share_of(delta, part, plane_of_part(plane, part, model), side, length));
  }
  return kept;
}

/// The plain slider of a shape that may be split.
int plain_slider_of(const Character& character, int shape) {
  const std::string& name = character.shapes[static_cast<std::size_t>(shape)].name;
  const auto uses = [&](const Slider& slider) {
    return std::any_of(slider.stops.begin(), slider.stops.end(),
                       [&](const SliderStop& s) { return s.shape == shape; });
  };
  const auto slider = std::find_if(character.sliders.begin(), character.sliders.end(), uses);
  const int index = static_cast<int>(slider - character.sliders.begin());
  const bool fires =
      std::any_of(character.correctives.begin(), character.correctives.end(), [&](const Corrective& c) {
        return c.shape == shape ||
               std::any_of(c.inputs.begin(), c.inputs.end(),
                           [&](const CorrectiveInput& input) { return input.slider == index; });
      });
  if (slider == character.sliders.end() || slider->stops.size() != 1 || fires)
    throw invalid_input("shape " + name, "is used by a corrective or by a slider with other stops",
                        "split shapes of plain sliders");
  return index;
}

/// A copy of each channel of the old slider or shape for the new ones.
void double_channels(Clip& clip, Channel::Property property, int Channel::*target, int old_index,
                     int new_index) {
  const std::size_t count = clip.channels.size();
  for (std::size_t c = 0; c < count; ++c) {
    if (clip.channels[c].property != property || clip.channels[c].*target != old_index) continue;
    Channel copy = clip.channels[c];
    copy.*target = new_index;
    clip.channels.push_back(std::move(copy));
  }
}

void split_one(Character& character, int shape, const MirrorPlane& plane, double width) {
  const auto index = static_cast<std::size_t>(shape);
  const int slider = plain_slider_of(character, shape);
  const Shape whole = character.shapes[index];
  Shape left = side_of_shape(character, whole, plane, Side::left, width);
  Shape right = side_of_shape(character, whole, plane, Side::right, width);
  for (const Shape* side : {&left, &right})
    if (find_shape(character, side->name) >= 0 || find_slider(character, side->name) >= 0)
      throw invalid_input("shape " + side->name, "exists", "rename it before " + whole.name + " is split");
  Slider other = character.sliders[static_cast<std::size_t>(slider)];
  character.sliders[static_cast<std::size_t>(slider)].name = left.name;
  other.name = right.name;
  other.stops[0].shape = static_cast<int>(character.shapes.size());
  character.shapes[index] = std::move(left);
  character.shapes.push_back(std::move(right));
  character.sliders.push_back(std::move(other));
  const int new_shape = static_cast<int>(character.shapes.size()) - 1;
  const int new_slider = static_cast<int>(character.sliders.size()) - 1;
  for (Clip& clip : character.clips) {
    double_channels(clip, Channel::Property::shape_weight, &Channel::shape, shape, new_shape);
    double_channels(clip, Channel::Property::slider, &Channel::slider, slider, new_slider);
  }
  for (Expression& expression : character.expressions) {
    const auto used = std::find_if(expression.values.begin(), expression.values.end(),
                                   [&](const ExpressionValue& value) { return value.slider == slider; });
    if (used != expression.values.end()) expression.values.push_back({new_slider, used->value});
  }
}

/// To model space: the node's transform of a part without a skin.
Eigen::Affine3d to_model(const Part& part, const std::vector<Eigen::Matrix4d>& model) {
  if (part.skin >= 0 || part.node < 0) return Eigen::Affine3d::Identity();
  return Eigen::Affine3d(model[static_cast<std::size_t>(part.node)]);
}

/// One part's surface, asked where the mirror images of another part's vertices lie (often the same part's).
class PartMirror {
 public:
  PartMirror(const Character& character, int from, int to, const MirrorPlane& plane)
      : to_(to),
        plane_(plane),
        triangles_(triangulate(character.parts[static_cast<std::size_t>(from)].mesh.faces)) {
    const std::vector<Eigen::Matrix4d> model = model_matrices(character);
    const Part& source = character.parts[static_cast<std::size_t>(from)];
    const Part& target = character.parts[static_cast<std::size_t>(to)];
    source_to_model_ = to_model(source, model);
    target_to_model_ = to_model(target, model);
    source_count_ = source.mesh.positions.rows();
    if (triangles_.rows() == 0) return;
    const SurfaceQuery query(source.mesh.positions, triangles_);
    const Eigen::Affine3d to_source = source_to_model_.inverse();
    for (Eigen::Index v = 0; v < target.mesh.positions.rows(); ++v) {
      const Eigen::Vector3d place =
          target_to_model_ * target.mesh.positions.row(v).cast<double>().transpose();
      hits_.push_back(query.closest(to_source * plane.mirrored(place)));
    }
  }

  PartDelta operator()(const PartDelta& delta, double least) const {
    PointsD dense = PointsD::Zero(source_count_, 3);
    for (std::size_t k = 0; k < delta.vertices.size(); ++k)
      dense.row(delta.vertices[k]) = delta.deltas.row(static_cast<Eigen::Index>(k)).cast<double>();
    PartDelta image;
    image.part = to_;
    const Eigen::Matrix3d to_target = target_to_model_.linear().inverse();
    std::vector<Eigen::Vector3d> moves;
    for (std::size_t v = 0; v < hits_.size(); ++v) {
      const SurfaceQuery::Hit& hit = hits_[v];
      Eigen::Vector3d there = Eigen::Vector3d::Zero();
      for (int k = 0; k < 3; ++k)
        there += hit.barycentric[k] * dense.row(triangles_(hit.triangle, k)).transpose();
      if (there.norm() <= least) continue;
      image.vertices.push_back(static_cast<int>(v));
      moves.push_back(to_target * plane_.mirrored_vector(source_to_model_.linear() * there));
    }
    image.deltas.resize(static_cast<Eigen::Index>(moves.size()), 3);
    for (std::size_t k = 0; k < moves.size(); ++k)
      image.deltas.row(static_cast<Eigen::Index>(k)) = moves[k].transpose().cast<float>();
    return image;
  }

 private:
  int to_;
  MirrorPlane plane_;
  Triangles triangles_;
  Eigen::Affine3d source_to_model_ = Eigen::Affine3d::Identity(),
                  target_to_model_ = Eigen::Affine3d::Identity();
  Eigen::Index source_count_ = 0;
  std::vector<SurfaceQuery::Hit> hits_;
};

/// The part on the other side: eyeRight for eyeLeft, else the part itself.
int partner_of(const Character& character, int part) {
  const std::string other = mirrored_name(character.parts[static_cast<std::size_t>(part)].name);
  const int found = other.empty() ? -1 : find_part(character, other);
  return found >= 0 ? found : part;
}

}  // namespace

Character split_shapes(const Character& character, const std::vector<std::string>& shapes,
                       const MirrorPlane& plane, double width) {
  if (!(width > 0) || !std::isfinite(width))
    throw invalid_input("width", "is " + std::to_string(width), "give a share of the box's diagonal above 0");
  Character result = character;
  for (const std::string& name : shapes) {
    const int shape = find_shape(result, name);
    if (shape < 0)
      throw invalid_input("shape " + name, "does not exist", "name one that `mien inspect` lists");
    split_one(result, shape, plane, width);
  }
  return result;
}

MirroredShapes mirror_shapes(const Character& character, Side from, const MirrorPlane& plane, bool replace) {
  MirroredShapes result{character, {}, {}};
  std::vector<PartMirror> mirrors;
  for (int part = 0; part < static_cast<int>(character.parts.size()); ++part)
    mirrors.emplace_back(character, part, partner_of(character, part), plane);
  bool any = false;
  for (const Shape& shape : character.shapes) {
    // jawLeft and the like are whole actions whose mirror image is another action; they are mirrored all the same.
    if (side_of_name(shape.name) != from) continue;
    any = true;
    const std::string name = mirrored_name(shape.name);
    const int known = find_shape(character, name);
    if (known >= 0 && !replace) continue;
    Shape image{name, {}};
    for (const PartDelta& delta : shape.parts) {
      const double least =
          least_motion *
          bounding_box(character.parts[static_cast<std::size_t>(delta.part)].mesh.positions).diagonal();
      image.parts.push_back(mirrors[static_cast<std::size_t>(delta.part)](delta, least));
    }
    std::sort(image.parts.begin(), image.parts.end(),
              [](const PartDelta& a, const PartDelta& b) { return a.part < b.part; });
    (known >= 0 ? result.replaced : result.made).push_back(name);
    if (known >= 0)
      result.character.shapes[static_cast<std::size_t>(known)] = std::move(image);
    else
      result.character.shapes.push_back(std::move(image));
  }
  if (!any)
    throw invalid_input("shapes",
                        std::string("none is named after the ") + (from == Side::left ? "left" : "right"),
                        "give names such as mouthSmileLeft or eyeBlink_R");
  complete_sliders(result.character);
  return result;
}

}  // namespace mien
