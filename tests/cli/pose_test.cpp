// What `mien pose`, `mien attenuate` and `mien inspect --interference` accept, refuse and write.

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <string>

#include "cli/run_program.h"

namespace mien::test {
namespace {

/// A pyramid whose tip two shapes move apart; a third does nothing there.
class Posing : public ::testing::Test {
 protected:
  void SetUp() override {
    const std::string faces = "f 1 2 4\nf 2 3 4\nf 3 1 4\n";
    folder.write("neutral.obj", "v -1 0 0\nv 1 0 0\nv 0 1 0\nv 0 0.4 1\n" + faces);
    folder.write("up.obj", "v -1 0 0\nv 1 0 0\nv 0 1 0\nv 0 0.9 1\n" + faces);
    folder.write("side.obj", "v -1 0 0\nv 1.5 0 0\nv 0 1 0\nv 0.5 0.4 1\n" + faces);
    folder.write("base.obj", "v -1.5 0 0\nv 1 0 0\nv 0 1 0\nv 0 0.4 1\n" + faces);
    ASSERT_EQ(run_mien(folder, "assemble " + folder / "neutral.obj" + " " + folder / "up.obj" + " " +
                                   folder / "side.obj" + " " + folder / "base.obj" + " --quiet -o " + face)
                  .exit_code,
              0);
  }
  Ran pose(const std::string& pins, const std::string& rest = "") const {
    folder.write("pins.json", pins);
    return run_mien(folder,
                    "pose " + face + " --pins " + folder / "pins.json" + " --quiet -o " + out + " " + rest);
  }
  nlohmann::json weights() const { return nlohmann::json::parse(text_of(out))["weights"]; }
  void refuse(const std::string& pins, const std::string& part_of_text, const std::string& rest = "") const {
    SCOPED_TRACE(pins);
    expect_failure(pose(pins, rest), part_of_text);
    EXPECT_FALSE(std::filesystem::exists(out));
  }
  const Folder folder;
  const std::string face = folder / "face.glb", out = folder / "out.json";
};

TEST_F(Posing, pulls_sliders_by_a_vertex) {
  ASSERT_EQ(pose(R"({"pins": [{"at": {"vertex": 3}, "move": [0.25, 0.2, 0]}]})").exit_code, 0);
  EXPECT_NEAR(weights()["up"].get<double>(), 0.4, 0.002);
  EXPECT_NEAR(weights()["side"].get<double>(), 0.5, 0.002);
  EXPECT_FALSE(weights().contains("base"));
  ASSERT_EQ(
      pose(
          R"({"pins": [{"at": {"vertex": 3}, "goal": [0.25, 0.6, 1], "hard": true}], "limits": {"side": [0, 0.3]}})")
          .exit_code,
      0);
  EXPECT_NEAR(weights()["up"].get<double>(), 0.4, 1e-5);
  EXPECT_NEAR(weights()["side"].get<double>(), 0.3, 1e-12);
}

/// Eq. 3 by hand: each slider moves one axis, so each is b m + alpha w0 over b^2 + alpha + mu.
TEST_F(Posing, alpha_and_mu_are_in_the_files_units) {
  folder.write("start.json", R"({"weights": {"up": 0.5}})");
  ASSERT_EQ(pose(R"({"pins": [{"at": {"vertex": 3}, "move": [0, 0.1, 0], "axes": "xyz"}]})",
                 "--alpha 0.1 --mu 0.01 --start " + folder / "start.json")
                .exit_code,
            0);
  EXPECT_NEAR(weights()["up"].get<double>(), (0.5 * 0.35 + 0.1 * 0.5) / (0.25 + 0.11), 1e-6);
}

TEST_F(Posing, writes_the_posed_face) {
  folder.write("pins.json", R"({"pins": [{"at": {"vertex": 3}, "move": [0, 0.5, 0]}]})");
  const std::string command = "pose " + face + " --pins " + folder / "pins.json" + " --quiet -o ";
  ASSERT_EQ(run_mien(folder, command + folder / "posed.obj").exit_code, 0);
  EXPECT_NE(text_of(folder / "posed.obj").find("v 0 0.899"), std::string::npos)
      << text_of(folder / "posed.obj");
  ASSERT_EQ(run_mien(folder, command + folder / "posed.glb").exit_code, 0);
  const Ran ran = run_mien(folder, "inspect --json " + folder / "posed.glb");
  EXPECT_EQ(nlohmann::json::parse(ran.out)["vertices"], 4);
}

TEST_F(Posing, refuses_what_it_cannot_use) {
  const std::string at = R"({"at": {"vertex": 3}, )";
  refuse(R"({"pins": []})", "has no \"pins\"");
  refuse(R"({"pins": [{"at": {"vertex": 4}, "move": [0, 0, 0]}]})", "pins[0].at.vertex");
  refuse(R"({"pins": [{"at": {"face": 0, "barycentric": [0.5, 0.6, 0.2]}, "move": [0, 0, 0]}]})",
         "barycentric");
  refuse(R"({"pins": [{"at": {"position": [9, 9, 9]}, "move": [0, 0, 0]}]})", "off the surface");
  refuse(R"({"pins": [)" + at + R"("move": [0, null, 0]}]})", "pins[0].move");
  refuse(R"({"pins": [)" + at + R"("move": [0, 1e999, 0]}]})", "out of range");
  refuse(R"({"pins": [)" + at + R"("move": [0, 0, 0], "goal": [0, 0, 0]}]})", "has both");
  refuse(R"({"pins": [)" + at + R"("move": [0, 0, 0], "axes": "xw"}]})", "some of x, y and z");
  refuse(R"({"pins": [)" + at + R"("move": [0, 0, 0]}], "locked": ["upp"]})", "perhaps up");
  refuse(R"({"pins": [)" + at + R"("move": [0, 0, 0]}], "limits": {"smile": [0, 1]}})",
         "slider smile: does not exist");
  refuse(R"({"pins": [)" + at + R"("move": [0, 0, 0]}], "limits": {"up": [1, 0]}})", "limits.up");
  refuse(R"({"pins": [)" + at + R"("move": [0, 1, 0], "hard": true}, )" + at +
             R"("move": [0, 2, 0], "hard": true}]})",
         "pin 2: is hard, on the same point as pin 1");
  refuse(R"({"pins": [{"at": {"vertex": 2}, "move": [0, 1, 0]}]})", "pin 1: cannot be moved");
  refuse(R"({"pins": [)" + at + R"("move": [0, 0, 0]}]})", "rho: is not above 0", "--rho 0");
}

TEST_F(Posing, attenuates) {
  folder.write("tags.json", R"({"tags": [{"at": {"vertex": 3}, "axes": "x"}]})");
  folder.write("from.json", R"({"weights": {"up": 0.2}})");
  folder.write("to.json", R"({"weights": {"up": 0.6, "side": 0.8}})");
  const auto attenuate = [&](const std::string& to, const std::string& rest) {
    return run_mien(folder, "attenuate " + face + " --tags " + folder / "tags.json" + " --from " +
                                folder / "from.json" + " --to " + folder / to + " --quiet -o " + out + " " +
                                rest);
  };
  ASSERT_EQ(attenuate("to.json", "--alpha 100").exit_code, 0);
  EXPECT_NEAR(weights()["up"].get<double>(), 0.6, 1e-6);
  EXPECT_NEAR(weights()["side"].get<double>(), 0.8 / 101,
              1e-6);  // P = Q: it moves two points as far, one of them tagged
  ASSERT_EQ(attenuate("from.json", "").exit_code, 0);
  EXPECT_NEAR(weights()["up"].get<double>(), 0.2, 1e-12);
  std::filesystem::remove(out);
  expect_failure(attenuate("to.json", "--alpha -1"), "alpha: is negative");
  folder.write("tags.json", R"({"tags": [{"at": {"vertex": 30}}]})");
  expect_failure(attenuate("to.json", ""), "tags[0].at.vertex");
  EXPECT_FALSE(std::filesystem::exists(out));
}

TEST_F(Posing, reports_interference) {
  const Ran ran =
      run_mien(folder, "inspect " + face + " --json --interference --picture " + folder / "matrix.png");
  ASSERT_EQ(ran.exit_code, 0) << ran.err;
  const nlohmann::json pairs = nlohmann::json::parse(ran.out)["interference"]["pairs"];
  ASSERT_EQ(pairs.size(), 1u);
  EXPECT_EQ(pairs[0]["vertex"], 3);
  EXPECT_TRUE(text_of(folder / "matrix.png").starts_with("\x89PNG"));
  folder.write("rules.json", R"({"rules": [{"region": [{"vertex": 3}], "sliders": ["up"]}]})");
  expect_failure(run_mien(folder, "inspect " + face + " --rules " + folder / "rules.json"), "need a clip");
}

}  // namespace
}  // namespace mien::test
