// What lies in and on the head, with names and without.
#include <gtest/gtest.h>

#include <Eigen/SVD>
#include <string>

#include "transfer/transferred.h"

namespace mien::test {
namespace {

/// Displacements of a part in jawOpen.
PointsD opened(const Character& character, int part) {
  return delta_of(character, static_cast<std::size_t>(find_shape(character, "jawOpen")), part);
}

/// The largest singular value of what remains of a motion after the best affine map of the part, over the motion.
double bend(const PointsD& rest, const PointsD& delta) {
  Eigen::MatrixXd a(rest.rows(), 4);
  a << rest, Eigen::VectorXd::Ones(rest.rows());
  const Eigen::MatrixXd fitted = a * a.colPivHouseholderQr().solve(Eigen::MatrixXd(delta));
  return (fitted - delta).norm() / delta.norm();
}

Character nameless(Character character) {
  for (std::size_t p = 0; p < character.parts.size(); ++p) character.parts[p].name = "piece";
  return character;
}

TEST(inner_pieces, teeth_without_names_move_with_teeth) {
  const Character& target = made("creature");
  const Character named = transferred("human", "creature").character;
  const Character unnamed = transfer(made("human"), nameless(target)).character;
  const int lower = part_named(target, "teethLower"), upper = part_named(target, "teethUpper");
  const PointsD wanted = opened(named, lower), got = opened(unnamed, lower);
  ASSERT_GT(wanted.norm(), 0);
  EXPECT_LT((got - wanted).norm(), 0.05 * wanted.norm());
  EXPECT_LT(opened(unnamed, upper).norm(), 0.02 * wanted.norm());
  EXPECT_LT(bend(target.parts[static_cast<std::size_t>(lower)].mesh.positions.cast<double>(), got), 1e-3);
}

TEST(inner_pieces, lower_teeth_are_found_under_another_name_where_they_move) {
  Character source = without_joints(made("human"));
  source.parts[static_cast<std::size_t>(part_named(source, "teethLower"))].name = "bits";
  source.parts[static_cast<std::size_t>(part_named(source, "teethUpper"))].name = "teeth";
  const Character& target = made("creature");
  const int lower = part_named(target, "teethLower");
  const PointsD wanted = opened(transfer(without_joints(made("human")), target).character, lower),
                got = opened(transfer(source, target).character, lower);
  ASSERT_GT(wanted.norm(), 0);
  EXPECT_LT((got - wanted).norm(), 0.05 * wanted.norm());
}

TEST(inner_pieces, lower_teeth_go_with_the_jaw_where_the_sources_stand_still) {
  Character source = without_joints(made("human"));
  const int own = part_named(source, "teethLower");
  for (Shape& shape : source.shapes)
    std::erase_if(shape.parts, [&](const PartDelta& delta) { return delta.part == own; });
  const Character& target = made("creature");
  const Character rigged = transfer(source, target).character;
  const int lower = part_named(target, "teethLower");
  const PointsD got = opened(rigged, lower),
                wanted = opened(transferred("human", "creature").character, lower);
  EXPECT_GT(got.norm(), 0.5 * wanted.norm());
  EXPECT_GT(got.cwiseProduct(wanted).sum(), 0.8 * got.norm() * wanted.norm());
  EXPECT_LT(opened(rigged, part_named(target, "teethUpper")).norm(), 1e-9);
}

/// One more part: a strip from the upper to the lower lid in front of the left eye.
Character with_a_film(Character character, int& film) {
  const Points& face = character.parts[0].mesh.positions;
  const auto at = [&](int number) { return face.row(landmark_vertex(character, number)).eval(); };
  Part part;
  part.name = "film";
  constexpr int rows = 8;
  part.mesh.positions.resize(2 * (rows + 1), 3);
  for (int r = 0; r <= rows; ++r) {
    const float t = static_cast<float>(r) / rows;
    part.mesh.positions.row(2 * r) = (1 - t) * at(44) + t * at(48);
    part.mesh.positions.row(2 * r + 1) = (1 - t) * at(45) + t * at(47);
    if (r < rows) part.mesh.faces.push_back({2 * r, 2 * r + 1, 2 * r + 3, 2 * r + 2});
  }
  film = static_cast<int>(character.parts.size());
  character.parts.push_back(part);
  return character;
}

TEST(inner_pieces, a_film_between_the_lids_goes_with_both) {
  int film = 0;
  const Character target = with_a_film(made("creature"), film);
  const Character rigged = transfer(made("human"), target).character;
  const auto blink = static_cast<std::size_t>(find_shape(rigged, "eyeBlinkLeft"));
  const PointsD moved = delta_of(rigged, blink, film), skin = delta_of(rigged, blink, 0);
  const auto lid = [&](int number) { return skin.row(landmark_vertex(target, number)).eval(); };
  ASSERT_GT(lid(44).norm(), 0);
  EXPECT_LT((moved.row(0) - lid(44)).norm(), 0.05 * lid(44).norm());
  EXPECT_LT((moved.row(16) - lid(48)).norm(), 0.05 * lid(44).norm());
  for (int r = 1; r <= 8; ++r)  // evenly from the one to the other: nothing jumps
    EXPECT_LT((moved.row(2 * r) - moved.row(2 * r - 2)).norm(), 0.4 * (lid(44) - lid(48)).norm()) << r;
}

TEST(inner_pieces, what_lies_off_the_skin_goes_with_the_sources_skin) {
  int film = 0;
  Character target = with_a_film(made("creature"), film);
  const auto way = [&] {
    const TransferReport report = transfer(made("human"), target).report;
    for (const PieceReport& piece : report.pieces)
      if (piece.piece == "film") return piece.way;
    return std::string("none");
  };
  EXPECT_EQ(way(), "skin beneath");
  Points& positions = target.parts[static_cast<std::size_t>(film)].mesh.positions;
  positions.col(2).array() += 2 * static_cast<float>(bounding_box(positions).diagonal());
  EXPECT_EQ(way(), "source part");
}

}  // namespace
}  // namespace mien::test
