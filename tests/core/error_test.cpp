#include "mien/core/error.h"

#include <gtest/gtest.h>

#include "mien/core/progress.h"

namespace mien {
namespace {

TEST(error, text_is_place_problem_remedy) {
  EXPECT_STREQ(invalid_input("shape smile", "holds NaN", "give finite numbers").what(),
               "shape smile: holds NaN; give finite numbers");
  EXPECT_STREQ(invalid_input("", "is empty").what(), "is empty");
}

TEST(error, text_is_one_line) {
  EXPECT_STREQ(io_error("line\n4", "got \"a\r\nb\"", "x").what(), "line 4: got \"a  b\"; x");
  EXPECT_STREQ(io_error("", "x").in_file("two\nlines.glb").what(), "two lines.glb: x");
}

TEST(error, a_file_is_named_once) {
  const Error error = io_error("line 4", "is short").in_file("a.obj");
  EXPECT_STREQ(error.what(), "a.obj: line 4: is short");
  EXPECT_STREQ(error.in_file("b.obj").what(), "a.obj: line 4: is short");
  EXPECT_EQ(error.kind(), Error::Kind::io);
}

TEST(progress, saying_stop_cancels) {
  EXPECT_NO_THROW(report_progress({}, "fit", 0.5));
  EXPECT_NO_THROW(report_progress([](std::string_view, double) { return true; }, "fit", 0.5));
  try {
    report_progress([](std::string_view, double) { return false; }, "fit", 0.5);
    FAIL() << "did not cancel";
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), Error::Kind::cancelled);
    EXPECT_STREQ(error.what(), "fit: cancelled");
  }
}

}  // namespace
}  // namespace mien
