#pragma once
/// What VRM 1.0 says of a character besides glTF: who made it, which node is which bone, what its expressions are. Data only.

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

namespace mien {

/// Members of VRMC_vrm's meta; only what is set is written.
struct VrmMeta {
  std::string name;                  ///< required
  std::vector<std::string> authors;  ///< one or more
  std::string license_url = "https://vrm.dev/licenses/1.0/";
  std::string version, copyright_information, contact_information, third_party_licenses, other_license_url;
  std::vector<std::string> references;
};

/// How much of a shape an expression shows at 1.
struct VrmBind {
  int shape = 0;      ///< index into Character::shapes
  double weight = 1;  ///< [0, 1]
};

/// What an expression does to lip sync, blinks and gaze while it is on.
enum class VrmOverride { none, block, blend };

struct VrmExpression {
  std::string name;        ///< unique
  bool is_preset = false;  ///< one of VRM's eighteen
  std::vector<VrmBind> binds;
  bool is_binary = false;  ///< on or off, nothing between
  VrmOverride mouth = VrmOverride::none, blink = VrmOverride::none, look_at = VrmOverride::none;
};

struct VrmBone {
  std::string name;  ///< VRM's: `hips`, `leftUpperArm`
  int node = 0;      ///< index into Character::nodes
};

/// How far eyes or expressions go for a look to the side; degrees in, degrees or an expression's weight out.
struct VrmLookAt {
  bool by_bones = true;  ///< else by the expressions lookUp ...
  Eigen::Vector3d offset_from_head =
      Eigen::Vector3d::Zero();  ///< the middle of the eyes, in the head bone's space
  double input_max = 90, output_scale = 10;
};

struct VrmAvatar {
  VrmMeta meta;
  std::vector<VrmBone> bones;
  std::vector<VrmExpression> expressions;
  std::optional<VrmLookAt> look_at;
};

}  // namespace mien
