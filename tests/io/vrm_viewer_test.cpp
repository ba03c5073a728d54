// What a VRM viewer (three.js with @pixiv/three-vrm) makes of our avatars.
#include <gtest/gtest.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "full_character.h"
#include "mien/io/vrm.h"
#include "mien/naming/plan_vrm.h"
#include "npm.h"
#include "support.h"

namespace mien {
namespace {

nlohmann::json seen_by_a_viewer(const std::filesystem::path& packages, const std::filesystem::path& file) {
  const test::Folder folder;
  const std::string out = (folder / "out.json").string();
  const std::string command = "node '" MIEN_SOURCE "/tests/tools/load_vrm.mjs' '" + packages.string() +
                              "' '" + file.string() + "' > '" + out + "' 2>&1";
  const int code = std::system(command.c_str());
  const std::vector<std::uint8_t> text = read_file(out);
  EXPECT_EQ(code, 0) << std::string(text.begin(), text.end());
  return code == 0 ? nlohmann::json::parse(text) : nlohmann::json();
}

TEST(VrmViewer, ShowsBonesAndExpressions) {
  if (!test::has_node()) GTEST_SKIP() << "node and npm are not installed";
  const std::filesystem::path packages =
      test::npm_packages("@pixiv/three-vrm", "three@0.170.0 @pixiv/three-vrm@3.5.5");
  if (packages.empty()) GTEST_SKIP() << "npm cannot install three-vrm here";
  Character character = test::full_character();
  character.shapes[1].name = character.sliders[1].name = "mouthSmileLeft";
  VrmMeta meta;
  meta.name = "Ada";
  meta.authors = {"K"};
  const VrmPlan plan = plan_vrm(character, meta);
  const test::Folder folder;
  write_vrm(plan.character, plan.avatar, folder / "ada.vrm");
  const nlohmann::json seen = seen_by_a_viewer(packages, folder / "ada.vrm");
  if (seen.is_null()) return;
  EXPECT_EQ(seen["version"], "1");
  EXPECT_EQ(seen["name"], "Ada");
  std::vector<std::string> bones, expressions;
  for (const VrmBone& bone : plan.avatar.bones) bones.push_back(bone.name);
  for (const VrmExpression& expression : plan.avatar.expressions) expressions.push_back(expression.name);
  std::sort(bones.begin(), bones.end());
  std::sort(expressions.begin(), expressions.end());
  EXPECT_EQ(seen["bones"], nlohmann::json(bones));
  EXPECT_EQ(seen["expressions"], nlohmann::json(expressions));
  for (const VrmExpression& expression : plan.avatar.expressions)
    EXPECT_GT(seen["moved"][expression.name]["count"], 0) << expression.name;
}

}  // namespace
}  // namespace mien
