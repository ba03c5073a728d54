#include "mien/io/control_config_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "mien/controls/make_controls.h"
#include "support.h"

namespace mien {
namespace {

using test::Folder;
using ::testing::HasSubstr;

ControlConfig full_config() {
  ControlConfig config = default_control_config();
  config.names = {{"CTL_*_L", "*Left"}};
  config.mirrors = {{"*_A", "*_B"}};
  ControlLimits jaw{"jaw", ValueRange{0, 1.5}, {}, {}};
  jaw.rotation[0] = {-0.25, std::numeric_limits<double>::infinity()};
  jaw.translation[2] = {0, 0.1};
  config.limits = {jaw};
  config.layout.width = 6;
  config.other = "rest";
  return config;
}

TEST(ControlConfigFile, BadOnesAreSaid) {
  const Folder folder;
  const auto error_in = [&](const std::string& text) {
    const auto path = folder.write("c.json", text);
    return test::error_of([&] { read_control_config(path, default_control_config()); });
  };
  EXPECT_THAT(error_in("[]"), HasSubstr("c.json"));
  EXPECT_THAT(error_in(R"({"region": []})"), HasSubstr("has an unknown member \"region\""));
  EXPECT_THAT(error_in(R"({"regions": [{"match": ["a"]}]})"), HasSubstr("regions[0]: has no \"name\""));
  EXPECT_THAT(error_in(R"({"regions": [{"name": "a", "side": "up"}]})"),
              HasSubstr("regions[0].side: is \"up\"; give left or right, or leave it out"));
  EXPECT_THAT(error_in(R"({"limits": [{"match": "a", "slider": [1]}]})"), HasSubstr("limits[0].slider"));
  EXPECT_THAT(error_in(R"({"limits": [{"match": "a", "rotation": {"x": 1}}]})"),
              HasSubstr("rotation.x: is no range"));
  EXPECT_THAT(error_in(R"({"mirrors": ["a"]})"), HasSubstr("mirrors[0]"));
  EXPECT_THAT(error_in(R"({"mirrors": [["a"]]})"), HasSubstr("mirrors: holds no pairs"));
  EXPECT_THAT(error_in(R"({"layout": {"columns": 3}})"), HasSubstr("layout.columns: is no array"));
}

TEST(ControlConfigFile, ComesBackWhole) {
  const Folder folder;
  const ControlConfig config = full_config();
  const auto path = folder.write("c.json", control_config_text(config));
  EXPECT_EQ(read_control_config(path, {}), config);
}

TEST(ControlConfigFile, WhatIsLeftOutIsUsual) {
  const Folder folder;
  const auto path = folder.write("c.json", R"({"moves": ["jaw"], "layout": {"rows": 12}})");
  ControlConfig expected = default_control_config();
  expected.moves = {"jaw"};
  expected.layout.rows = 12;
  EXPECT_EQ(read_control_config(path, default_control_config()), expected);
}

}  // namespace
}  // namespace mien
