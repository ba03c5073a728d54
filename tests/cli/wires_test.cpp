#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "cli/run_program.h"

namespace mien::test {
namespace {

std::string quoted(const std::string& path) {
  return " '" + path + "' ";
}

using ::testing::HasSubstr;

TEST(WiresCommand, FindsWiresBlendsThemAndRefusesOddFiles) {
  const Folder folder;
  ASSERT_EQ(run_mien(folder, "sample human --quiet -o" + quoted(folder.path().string())).exit_code, 0);
  const std::string human = folder / "human.glb", out = folder / "wires.glb";
  const Ran made = run_mien(folder, "wires --count 15 --keep-ranges --json" + quoted(human) + "-o" +
                                        quoted(out) + "--reconstruct" + quoted(folder / "rebuilt"));
  ASSERT_EQ(made.exit_code, 0) << made.err;
  const auto json = nlohmann::json::parse(made.out);
  EXPECT_EQ(json["wires"].size(), 15u);
  EXPECT_LT(json["error"].get<double>(), 0.4 * json["displacement"].get<double>());
  EXPECT_TRUE(std::filesystem::exists(folder / "rebuilt/jawOpen.obj"));

  folder.write("from.json", R"({"weights": {"jawOpen": 0.6}})");
  folder.write("to.json", R"({"weights": {"eyeBlinkLeft": 1}})");
  const auto blend = [&](const std::string& character, const std::string& feature) {
    return run_mien(folder, "blend --frames 8" + quoted(character) + "--from" + quoted(folder / "from.json") +
                                "--to" + quoted(folder / "to.json") + "--feature" + quoted(feature) + "-o" +
                                quoted(folder / "blend.glb"));
  };
  EXPECT_EQ(blend(out, "ears=sqrt").err,
            "mien: " + out + ": feature ears: has no wire; there are brows, eyes, nose, mouth, jaw\n");
  EXPECT_THAT(blend(out, "eyes=fast").err,
              HasSubstr("function fast: is not one; linear, sqrt, cube, or points"));
  EXPECT_EQ(blend(human, "eyes=sqrt").err,
            "mien: " + human + ": wires: are none; a character with wires (mien wires)\n");
  EXPECT_FALSE(std::filesystem::exists(folder / "blend.glb"));
  EXPECT_EQ(blend(out, "eyes=sqrt").exit_code, 0);
  EXPECT_TRUE(std::filesystem::exists(folder / "blend.glb"));
}

TEST(WiresCommand, PinsMoveTheWiresThatTheyName) {
  const Folder folder;
  ASSERT_EQ(run_mien(folder, "sample human --quiet -o" + quoted(folder.path().string())).exit_code, 0);
  const std::string wires = folder / "wires.glb", out = folder / "pulled.json";
  ASSERT_EQ(run_mien(folder, "wires --count 15 --keep-ranges --exact --quiet" + quoted(folder / "human.glb") +
                                 "-o" + quoted(wires) + "--write-curves" + quoted(folder / "curves.json"))
                .exit_code,
            0);
  const auto curves = nlohmann::json::parse(text_of(folder / "curves.json"));
  ASSERT_EQ(curves["curves"].size(), 15u);
  const auto point = curves["curves"]["brow_L"]["points"][2];
  const auto pull = [&](const std::string& names) {
    const nlohmann::json pins = {{"pins", {{{"at", point}, {"move", {0, 0.03, 0}}}}},
                                 {"wires", nlohmann::json::parse(names)}};
    folder.write("pins.json", pins.dump());
    return run_mien(
        folder, "pose --json" + quoted(wires) + "--pins" + quoted(folder / "pins.json") + "-o" + quoted(out));
  };
  EXPECT_THAT(pull(R"(["brow"])").err,
              HasSubstr("wires: wire brow: does not exist; name one of the 15 wires, perhaps brow_"));
  EXPECT_FALSE(std::filesystem::exists(out));
  const Ran still = pull("[]"), pulled = pull(R"(["brow_L"])");
  ASSERT_EQ(pulled.exit_code, 0) << pulled.err;
  EXPECT_EQ(nlohmann::json::parse(pulled.out)["wires"], nlohmann::json({"brow_L"}));
  EXPECT_LT(nlohmann::json::parse(pulled.out)["misses"][0].get<double>(), 0.001);
  const auto written = nlohmann::json::parse(text_of(folder / "pulled.json"));
  EXPECT_EQ(written["wires"]["brow_L"]["controls"].size(), 10u);
  EXPECT_EQ(run_mien(folder, "render" + quoted(wires) + "--size 64,64 --weights" + quoted(out) + "-o" +
                                 quoted(folder / "pulled.png"))
                .exit_code,
            0);
}

TEST(WiresCommand, NamesTheOptionThatIsWrong) {
  const Folder folder;
  const auto with = [&](const std::string& option) {
    const Ran ran = run_mien(folder, "wires face.glb -o" + quoted(folder / "out.glb") + option);
    EXPECT_EQ(ran.exit_code, 1);
    EXPECT_FALSE(std::filesystem::exists(folder / "out.glb"));
    return ran.err;
  };
  EXPECT_EQ(with("--ridge 0"), "mien: --ridge: is 0; a finite number above 0, as 1e-4\n");
  EXPECT_THAT(with("--ridge nan"), HasSubstr("--ridge: is nan; a finite number"));
  EXPECT_EQ(with("--residual=-0.5"),
            "mien: --residual: is -0.5; a part of the face's box, 0 or more, as 0.002\n");
  EXPECT_EQ(with("--residual-vertices 1.5"),
            "mien: --residual-vertices: is 1.5; a share of the vertices, 0 to 1, as 0.02\n");
  EXPECT_EQ(with("--count 17"), "mien: --count: is 17; 15 or 22\n");
}

TEST(WiresCommand, WritesNothingWhereOnePlaceCannotBeWritten) {
  const Folder folder;
  ASSERT_EQ(run_mien(folder, "sample human --quiet -o" + quoted(folder.path().string())).exit_code, 0);
  folder.write("file", "no folder");
  for (const char* option : {"--reconstruct", "--report", "--write-curves"}) {
    const Ran ran = run_mien(folder, "wires --count 15 --keep-ranges" + quoted(folder / "human.glb") + "-o" +
                                         quoted(folder / "out.glb") + option + quoted(folder / "file/there"));
    EXPECT_EQ(ran.exit_code, 1) << option;
    EXPECT_THAT(ran.err, HasSubstr("file/there: ")) << option;
    EXPECT_FALSE(std::filesystem::exists(folder / "out.glb")) << option;
  }
}

TEST(WiresCommand, RefusesOddCurves) {
  const Folder folder;
  ASSERT_EQ(run_mien(folder, "sample human --quiet -o" + quoted(folder.path().string())).exit_code, 0);
  const auto with = [&](const std::string& curves) {
    folder.write("curves.json", curves);
    const Ran ran = run_mien(folder, "wires" + quoted(folder / "human.glb") + "--curves" +
                                         quoted(folder / "curves.json") + "-o" + quoted(folder / "out.glb"));
    EXPECT_EQ(ran.exit_code, 1);
    EXPECT_FALSE(std::filesystem::exists(folder / "out.glb"));
    return ran.err;
  };
  EXPECT_THAT(with("{}"), HasSubstr("curves.json: file: has no \"curves\""));
  EXPECT_THAT(with(R"({"curves": {"a": {"points": [{"vertex": 1}, {"vertex": 2}, {"vertex": 3}]}}})"),
              HasSubstr("curve a.points: has 3 points; a cubic needs four or more"));
  EXPECT_THAT(
      with(
          R"({"curves": {"a": {"points": [{"vertex": 1}, {"vertex": 2}, {"vertex": 3}, {"vertex": 4}], "controls": 3}}})"),
      HasSubstr("a cubic needs four or more"));
  EXPECT_THAT(
      with(
          R"({"curves": {"a": {"points": [{"vertex": 1}, {"vertex": 2}, {"vertex": 3}, {"position": [900, 0, 0]}]}}})"),
      HasSubstr("off the surface"));
  EXPECT_THAT(
      with(
          R"({"curves": {"a": {"points": [{"vertex": 1}, {"vertex": 2}, {"vertex": 3}, {"vertex": 4}], "range": 1e-12}}})"),
      HasSubstr("wire a: reaches no vertex; a longer range"));
}

}  // namespace
}  // namespace mien::test
