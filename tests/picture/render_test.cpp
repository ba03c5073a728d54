#include "mien/picture/render.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>

#include "mien/core/error.h"
#include "mien/core/parallel.h"
#include "shapes_in_code.h"

namespace mien {
namespace {

using ::testing::HasSubstr;

RenderOptions small() {
  RenderOptions options;
  options.width = options.height = 64;
  return options;
}

Color at(const Picture& picture, int x, int y) {
  const std::uint8_t* p = picture.rgba.data() + 4 * (y * picture.width + x);
  return {p[0] / 255.f, p[1] / 255.f, p[2] / 255.f};
}

float bright(const Color& color) {
  return (color.r + color.g + color.b) / 3;
}

/// The largest difference of a channel between two pictures, in 1/255.
int worst(const Picture& a, const Picture& b) {
  int most = 0;
  for (std::size_t i = 0; i < a.rgba.size(); ++i) most = std::max(most, std::abs(a.rgba[i] - b.rgba[i]));
  return most;
}

std::string error_of(const Character& character, const std::vector<Points>& posed,
                     const RenderOptions& options) {
  try {
    render(character, posed, options);
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), Error::Kind::invalid_input);
    return error.what();
  }
  return "no error";
}

TEST(Render, InvalidInputs) {
  const Character ball = character_of({make_sphere("skin", 8)});
  std::vector<Points> posed = positions_of(ball);
  EXPECT_THAT(error_of(ball, {}, small()), HasSubstr("is given 0 parts; 1"));
  EXPECT_THAT(error_of(ball, {Points::Zero(3, 3)}, small()), HasSubstr("part skin: is given 3 positions"));
  posed[0](2, 1) = std::numeric_limits<float>::quiet_NaN();
  EXPECT_THAT(error_of(ball, posed, small()), HasSubstr("part skin: has a position that is not finite"));
  EXPECT_THAT(error_of({}, {}, small()), HasSubstr("shows no"));
  EXPECT_THAT(error_of(character_of({Part()}), {Points(0, 3)}, small()), HasSubstr("shows no"));
  RenderOptions options = small();
  options.width = -1;
  EXPECT_THAT(error_of(ball, positions_of(ball), options), HasSubstr("-1 x 64 pixels"));
  options = small();
  options.map.emplace();
  options.map->values = {Eigen::VectorXf::Zero(4)};
  EXPECT_THAT(error_of(ball, positions_of(ball), options), HasSubstr("vertex map: has 4 values for part 0"));
  Character broken = ball;
  broken.parts[0].mesh.faces.corners()[3] = 99999;
  EXPECT_NE(error_of(broken, positions_of(ball), small()), "no error");
}

TEST(Render, SphereCoversItsDisc) {
  const Character ball = character_of({make_sphere("skin", 48)});
  const RenderOptions options = small();
  const Picture picture = render(ball, positions_of(ball), options);
  int covered = 0;
  for (int y = 0; y < 64; ++y)
    for (int x = 0; x < 64; ++x) covered += !(at(picture, x, y) == at(picture, 0, 0));
  const double radius = 32 * (1 - 2 * FrameOptions().margin);
  EXPECT_NEAR(covered, std::numbers::pi * radius * radius, 2 * std::numbers::pi * radius);
  EXPECT_NEAR(at(picture, 0, 0).b, options.background.b, 1 / 255.f);
}

TEST(Render, SameBytesAtAnyThreadCount) {
  const Character ball = character_of({make_sphere("skin", 24), make_sphere("lashes", 9)});
  std::vector<Points> posed = positions_of(ball);
  posed[1].array() *= 0.7f;
  posed[1].array() += 0.4f;
  RenderOptions options = small();
  options.wireframe = true;
  const Picture all = render(ball, posed, options);
  set_thread_count(1);
  const Picture one = render(ball, posed, options);
  set_thread_count(0);
  EXPECT_EQ(one, all);
  EXPECT_EQ(Renderer(ball).render(posed, options), all);
}

TEST(Render, SizeOfTheUnitDoesNotMatter) {
  const Character ball = character_of({make_sphere("skin", 24)});
  const Picture picture = render(ball, positions_of(ball), small());
  for (const float scale : {0.01f, 100.f})
    EXPECT_LE(worst(render(ball, positions_of(ball, scale), small()), picture), 8) << scale;
}

TEST(Render, SeamIsInvisible) {
  const Character whole = character_of({make_sphere("skin", 12)});
  const Character split = character_of({make_sphere("skin", 12, true)});
  const Picture picture = render(whole, positions_of(whole), small());
  EXPECT_LE(worst(render(split, positions_of(split), small()), picture), 1);
}

TEST(Render, CoarseSphereHasNoTerminatorSteps) {
  // Along the middle column the shading falls from light to dark without a jump from one triangle to the
  // next.
  const Character ball = character_of({make_sphere("skin", 8)});
  RenderOptions options;
  options.width = options.height = 256;
  const Picture picture = render(ball, positions_of(ball), options);
  for (int y = 40; y < 215; ++y)
    EXPECT_LT(std::abs(bright(at(picture, 100, y + 1)) - bright(at(picture, 100, y))), 0.035f) << y;
}

TEST(Render, CavityIsDarkButNotBlack) {
  // A ball with a hole in front (the faces there are left out) inside which the back wall is seen.
  Part part = make_sphere("skin", 32);
  Faces kept;
  for (std::size_t f = 0; f < part.mesh.faces.size(); ++f) {
    const auto face = part.mesh.faces[f];
    if (part.mesh.positions(face[0], 2) < 0.93f) kept.push_back(face);
  }
  part.mesh.faces = kept;
  const Character ball = character_of({part});
  RenderOptions options = small();
  options.width = options.height = 128;
  const Picture picture = render(ball, positions_of(ball), options);
  const float inside = bright(at(picture, 64, 68)), outside = bright(at(picture, 44, 44));
  EXPECT_LT(inside, 0.35f * outside);
  EXPECT_GT(inside, 0.01f);
}

TEST(Render, ViewsShowTheirSide) {
  Part left = make_sphere("skin", 12), right = left;
  right.name = "teeth";
  left.mesh.positions.col(0).array() += 3;
  right.mesh.positions.col(0).array() -= 3;
  const Character two = character_of({left, right});
  RenderOptions options = small();
  options.view = View::left;
  const Color seen_left = at(render(two, positions_of(two), options), 32, 32);
  options.view = View::right;
  const Color seen_right = at(render(two, positions_of(two), options), 32, 32);
  EXPECT_GT(seen_left.r / seen_left.b, 1.25f);    // skin
  EXPECT_LT(seen_right.r / seen_right.b, 1.25f);  // teeth
}

TEST(Render, HiddenShellsAreLeftOutAndLashesAreSeenThrough) {
  Part shell = make_sphere("EyeOcclusion", 12);
  shell.mesh.positions *= 1.5f;
  const Character eye = character_of({make_sphere("eye", 12), shell});
  RenderOptions options = small();
  options.zoom = Box{Eigen::Vector3d::Constant(-1), Eigen::Vector3d::Constant(1)};
  const float white = bright(at(render(eye, positions_of(eye), options), 28, 26));
  EXPECT_GT(white, 0.7f);
  Character lashes = eye;
  lashes.parts[1].name = "lashes";
  const float seen_through = bright(at(render(lashes, positions_of(lashes), options), 28, 26));
  EXPECT_LT(seen_through, 0.9f * white);
  EXPECT_GT(seen_through, 0.3f * white);
}

TEST(Render, MaterialColorCounts) {
  Character ball = character_of({make_sphere("skin", 12)});
  ball.appearance.materials.push_back({"paint", {0, 0, 1, 1}, {}});
  ball.parts[0].mesh.groups.push_back({"", 0, 0, static_cast<int>(ball.parts[0].mesh.faces.size()), 0,
                                       static_cast<int>(ball.parts[0].mesh.vertex_count())});
  const Color color = at(render(ball, positions_of(ball), small()), 28, 28);
  EXPECT_GT(color.b, 2 * color.r);
}

TEST(Render, MapColorsTheValues) {
  const Character ball = character_of({make_sphere("skin", 12)});
  RenderOptions options = small();
  VertexMap map{
      {Eigen::VectorXf(ball.parts[0].mesh.positions.col(0))}, ColorMap::cool_warm, -1, 1, "x", true};
  options.map = map;
  const Picture picture = render(ball, positions_of(ball), options);
  EXPECT_GT(at(picture, 10, 30).b, 1.3f * at(picture, 10, 30).r);
  EXPECT_GT(at(picture, 54, 30).r, 1.3f * at(picture, 54, 30).b);
  options.map->values[0].setConstant(std::numeric_limits<float>::quiet_NaN());
  const Color grey = at(render(ball, positions_of(ball), options), 32, 30);
  EXPECT_NEAR(grey.r, grey.b, 0.05f);
}

TEST(Render, MarkersShowOnTheNearSideOnly) {
  const Character ball = character_of({make_sphere("skin", 24)});
  RenderOptions options = small();
  const Picture bare = render(ball, positions_of(ball), options);
  options.markers.push_back({{0, 0, -1}, "back", {0, 0, 1}});
  EXPECT_EQ(render(ball, positions_of(ball), options), bare);
  options.markers.push_back({{0, 0, 1}, "", {0, 0, 1}});
  const Color dot = at(render(ball, positions_of(ball), options), 32, 32);
  EXPECT_GT(dot.b, 0.9f);
  EXPECT_LT(dot.r, 0.2f);
  options.markers.clear();
  options.polylines.push_back({{{-0.5, 0.0, 0.87}, {0.0, 0.0, 1.0}, {0.5, 0.0, 0.87}}, {0, 1, 0}});
  EXPECT_GT(at(render(ball, positions_of(ball), options), 32, 32).g, 0.7f);
  options.polylines[0].points = {{-0.5, 0.0, -0.87}, {0.5, 0.0, -0.87}};
  EXPECT_EQ(render(ball, positions_of(ball), options), bare);
}

TEST(Render, FlatAndDegenerateFacesDoNoHarm) {
  Part part;
  part.mesh.positions.resize(5, 3);
  part.mesh.positions << 0, 0, 0, 1, 0, 0, 0, 1, 0, 0.5f, 0.5f, 0, 0.5f, 0.5f, 0;
  part.mesh.faces.push_back({0, 1, 2});
  part.mesh.faces.push_back({3, 4, 3});  // no area
  part.mesh.faces.push_back({0, 1});     // no polygon
  const Character flat = character_of({part});
  EXPECT_NE(render(flat, positions_of(flat), small()), blank_picture(64, 64, RenderOptions().background));
}

TEST(Render, BandsMeetWithoutASeam) {
  // So wide that it is traced in two bands of rows.
  const Character ball = character_of({make_sphere("skin", 24)});
  RenderOptions wide = small();
  wide.width = 9000;
  wide.height = 140;
  const Picture picture = render(ball, positions_of(ball), wide);
  const int middle = wide.width / 2;
  for (int y = 20; y < 120; ++y)
    EXPECT_LT(std::abs(bright(at(picture, middle, y + 1)) - bright(at(picture, middle, y))), 0.05f) << y;
}

TEST(Render, OddGeometryDoesNoHarm) {
  const Character ball = character_of({make_sphere("skin", 4)});
  for (const float scale : {0.f, 1e-35f, 1e-20f, 1e20f, 1e37f}) {
    const Picture picture = render(ball, positions_of(ball, scale), small());
    EXPECT_EQ(picture.rgba.size(), 4u * 64 * 64) << scale;
  }
  Points line = Points::Zero(ball.parts[0].mesh.positions.rows(), 3);
  line.col(1) = ball.parts[0].mesh.positions.col(1);
  EXPECT_EQ(render(ball, {line}, small()).width, 64);
  line.array() += 1e6f;
  EXPECT_EQ(render(ball, {line}, small()).width, 64);
}

}  // namespace
}  // namespace mien
