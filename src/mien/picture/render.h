#pragma once
/// Ray-traced stills of a character: good enough to judge a lip by, the same bytes at any thread count.

#include <Eigen/Core>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "mien/character/character.h"
#include "mien/picture/camera.h"
#include "mien/picture/color_map.h"
#include "mien/picture/picture.h"

namespace mien {

/// A point drawn on the surface, with a label or none. Not drawn where the face hides it; a label that would cover
/// another one is left out.
struct Marker {
  Eigen::Vector3d position = Eigen::Vector3d::Zero();  ///< model space
  std::string label;
  Color color = {0.85f, 0.1f, 0.1f};
};

/// A line drawn on the surface.
struct Polyline {
  std::vector<Eigen::Vector3d> points;  ///< model space
  Color color = {0.1f, 0.3f, 0.8f};
  bool hidden = false;  ///< stretches behind the surface are drawn too; false: left out
};

/// A number a vertex, drawn as colour in place of the part's own: error, weight and fold maps.
struct VertexMap {
  std::vector<Eigen::VectorXf> values;  ///< one #V a part; a part's may be empty, and a NaN is drawn grey
  ColorMap colors = ColorMap::heat;
  double low = 0, high = 1;  ///< the values at the two ends of the colours
  std::string title;         ///< over the legend, e.g. "error, % of the head"
  bool legend = true;
};

struct RenderOptions {
  int width = 512, height = 512;  ///< pixels
  View view = View::front;
  /// Model space to a space where the face looks along +Z with +Y up.
  Eigen::Matrix3d facing = Eigen::Matrix3d::Identity();
  std::optional<Camera> camera;  ///< instead of framing what is posed from `view`
  std::optional<Box> zoom;       ///< frames this box (model space) from `view`
  bool wireframe = false;        ///< the polygons' edges on top
  std::optional<VertexMap> map;
  std::vector<Marker> markers;
  std::vector<Polyline> polylines;
  Color background = {0.93f, 0.935f, 0.94f};
};

/// What surfaces are coloured by.
enum class Surfaces {
  clay,     ///< one colour a thing (skin, teeth, ...): shape shows best
  painted,  ///< the base-colour images and vertex colours that the character has, clay where it has none
};

/// Draws one character many times: what does not depend on the pose is prepared once.
class Renderer {
 public:
  explicit Renderer(const Character& character, Surfaces surfaces = Surfaces::clay);
  ~Renderer();
  Renderer(Renderer&&) noexcept;
  Renderer& operator=(Renderer&&) noexcept;

  ///   posed   one #V x 3 a part, model space (`evaluate`)
  ///   throws  invalid_input: sizes that differ from the character's, positions that are not finite, nothing
  ///           to show, a picture side out of range
  ///   cost    linear in pixels; 512 x 512 of a 27,000-vertex face takes about 0.4 s on two cores
  ///   method  rays (Embree) with 16 samples a pixel; smooth normals over welded seams; a soft key light with
  ///           shadows, sky light by ambient occlusion (filtered over 4 x 4 pixels along the surface), a little
  ///           gloss
  /// Colours: a material that has one keeps it; otherwise parts, groups and materials get a look by their
  /// names (skin, eye, iris, teeth, gum, lash); shells that only shade the eye (tear fluid, occlusion) are
  /// left out. Painted: sRGB images through their samplers (wrap, bilinear, KHR_texture_transform) times base-colour factor times
  /// vertex colours; alpha masks and blends let rays through and cast no shadow.
  Picture render(const std::vector<Points>& posed, const RenderOptions& options = {}) const;

  /// Images that cannot be drawn, and why; what has them keeps its base colour.
  const std::vector<std::string>& warnings() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// The same for one picture.
Picture render(const Character& character, const std::vector<Points>& posed,
               const RenderOptions& options = {});

}  // namespace mien
