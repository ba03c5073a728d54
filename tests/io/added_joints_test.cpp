// Joints added to a character that came from a file with its own scene.

#include <gmock/gmock.h>

#include "io/support.h"
#include "mien/io/load.h"

namespace mien::test {
namespace {

TEST(GltfScene, ShowsJointsThatWereAddedToAReadCharacter) {
  Character character;
  character.nodes.resize(2);
  character.nodes[0].name = "face";
  character.nodes[1].name = "jaw";
  Part part;
  part.name = "face";
  part.node = part.skin = 0;
  part.mesh.positions.resize(3, 3);
  part.mesh.positions << 0, 0, 0, 1, 0, 0, 0, 1, 0;
  part.mesh.faces.push_back({0, 1, 2});
  part.skin_weights = {{0, 1, 2, 3}, {0, 0, 0}, {1, 1, 1}};
  character.parts.push_back(part);
  Skin skin;
  skin.joints = {1};
  skin.inverse_bind = {Eigen::Matrix4d::Identity()};
  character.skins.push_back(skin);
  character.carried = R"({"scenes": [{"nodes": [0]}], "scene": 0})";

  const Folder folder;
  save(character, folder / "face.gltf");
  std::ifstream file(folder / "face.gltf");
  const auto json = nlohmann::json::parse(file);
  EXPECT_THAT(json["scenes"][0]["nodes"].get<std::vector<int>>(), ::testing::UnorderedElementsAre(0, 1));
}

}  // namespace
}  // namespace mien::test
