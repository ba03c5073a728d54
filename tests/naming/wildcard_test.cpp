#include "mien/naming/wildcard.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace mien {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

TEST(Wildcards, FitOrNot) {
  EXPECT_TRUE(fits_wildcards("mouth*", "mouthSmileLeft"));
  EXPECT_TRUE(fits_wildcards("MOUTH*left", "mouthSmileLeft"));
  EXPECT_TRUE(fits_wildcards("*", ""));
  EXPECT_TRUE(fits_wildcards("", ""));
  EXPECT_TRUE(fits_wildcards("a?c", "abc"));
  EXPECT_TRUE(fits_wildcards("*ab", "aab"));
  EXPECT_TRUE(fits_wildcards("**b*", "ab"));
  EXPECT_FALSE(fits_wildcards("mouth", "mouthSmile"));
  EXPECT_FALSE(fits_wildcards("a?c", "ac"));
  EXPECT_FALSE(fits_wildcards("", "a"));
  EXPECT_FALSE(fits_wildcards("*b?", "ab"));
}

TEST(Wildcards, WhatTheyStandForMovesToAnotherPattern) {
  EXPECT_THAT(match_wildcards("M_*_L", "M_browUp_L").value(), ElementsAre("browUp"));
  EXPECT_THAT(match_wildcards("*_?_*", "a_b_c_d_e").value(), ElementsAre("a", "b", "c_d_e"));
  EXPECT_THAT(match_wildcards("jaw", "JAW").value(), IsEmpty());
  EXPECT_EQ(fill_wildcards("*Left", {"browUp"}), "browUpLeft");
  EXPECT_EQ(fill_wildcards("?*-?", {"a", "b"}), "ab-");
}

TEST(Wildcards, ManyStarsTakeNoTime) {
  std::string pattern, name(20000, 'a');
  for (int k = 0; k < 200; ++k) pattern += "*a";
  EXPECT_FALSE(fits_wildcards(pattern + "b", name));
}

}  // namespace
}  // namespace mien
