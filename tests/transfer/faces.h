#pragma once
/// What the tests of transfer share: the built-in heads as plain surfaces, and small surfaces made in code.

#include <string>
#include <vector>

#include "geometry/shapes.h"
#include "mien/character/landmark_points.h"
#include "mien/character/weld.h"
#include "mien/transfer/register_surfaces.h"
#include "sample/made.h"

namespace mien::test {

/// The kind and the text that `call` fails with; a test failure when it does not.
template <typename Call>
std::string invalid_input_of(Call&& call) {
  try {
    call();
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), Error::Kind::invalid_input);
    return error.what();
  }
  ADD_FAILURE() << "did not fail";
  return "";
}

/// The first part, its UV seams joined.
struct FaceSkin {
  mien::Surface surface;
  std::vector<int> row_of;  ///< per vertex of the part
};
inline FaceSkin skin_of(const Character& character) {
  const Weld weld = weld_seams(character, 0);
  const Mesh& mesh = character.parts[0].mesh;
  FaceSkin skin;
  skin.surface.positions = mesh.positions(weld.representative, Eigen::all).cast<double>();
  skin.surface.triangles = triangulate(weld_faces(mesh.faces, weld));
  skin.row_of = weld.of;
  return skin;
}

inline PointsD landmark_positions(const Character& character) {
  PointsD positions(static_cast<Eigen::Index>(character.landmarks.size()), 3);
  Eigen::Index row = 0;
  for (const LandmarkPoint& point : landmark_points(character))
    positions.row(row++) = point.position.transpose();
  return positions;
}

inline Similarity some_similarity(double scale) {
  return {scale, Eigen::AngleAxisd(0.9, Eigen::Vector3d(1, -2, 0.5).normalized()).toRotationMatrix(),
          Eigen::Vector3d(3, -1, 2) * scale};
}

/// Two rows of `count` and `count` + 1 vertices, equilateral triangles of side 1 between them, along +x in the plane
/// z = 0. Cotangents of 60 degrees everywhere: functions linear in x are harmonic to the digit.
inline mien::Surface equilateral_strip(int count) {
  mien::Surface strip;
  strip.positions.resize(2 * count + 1, 3);
  for (int i = 0; i <= count; ++i) strip.positions.row(i) << i, 0, 0;
  for (int i = 0; i < count; ++i) strip.positions.row(count + 1 + i) << i + 0.5, std::sqrt(0.75), 0;
  strip.triangles.resize(2 * count - 1, 3);
  for (int i = 0; i < count; ++i) strip.triangles.row(i) << i, i + 1, count + 1 + i;
  for (int i = 0; i + 1 < count; ++i) strip.triangles.row(count + i) << i + 1, count + 2 + i, count + 1 + i;
  return strip;
}

/// A registration that brought `surface` nowhere: all of it is outer skin.
inline Registration no_registration(const mien::Surface& surface, double unit) {
  Registration registration;
  registration.guide = surface.positions;
  registration.unit = unit;
  registration.source_openness = registration.target_openness =
      Eigen::VectorXd::Ones(surface.positions.rows());
  return registration;
}

}  // namespace mien::test
