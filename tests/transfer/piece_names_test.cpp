#include <gtest/gtest.h>

#include "mien/sample/sample.h"
#include "mien/transfer/detail/inner_pieces.h"

namespace mien::detail {
namespace {

TEST(piece_names, kinds_are_read_from_part_and_group) {
  EXPECT_EQ(kind_from_name("l-eye"), PieceKind::eye);
  EXPECT_EQ(kind_from_name("upper-teeth"), PieceKind::teeth);
  EXPECT_EQ(kind_from_name("eyeLeft: white"), PieceKind::eye);
  EXPECT_EQ(kind_from_name("EyesAndLashes: Eye"), PieceKind::eye) << "the group knows better";
  EXPECT_EQ(kind_from_name("Eyes: Lashes"), PieceKind::lash);
  EXPECT_EQ(kind_from_name("eyelid"), PieceKind::other);
  EXPECT_EQ(kind_from_name("Hat: brim"), PieceKind::other);
}

// Rows of teeth are told apart by their part's name; their groups are called alike.
TEST(piece_names, keep_the_part_in_front_of_the_group) {
  const Pool pooled = pool(make_sample("human"));
  int upper = 0, lower = 0;
  for (const std::string& name : pooled.piece_name) {
    upper += name.starts_with("teethUpper");
    lower += name.starts_with("teethLower");
  }
  EXPECT_GT(upper, 0);
  EXPECT_GT(lower, 0);
}

}  // namespace
}  // namespace mien::detail
