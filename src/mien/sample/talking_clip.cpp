// A few words, said with the jaw's joint and the shapes of the lips, with blinks, brows and a moving head.

#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include "mien/sample/detail/character_form.h"

namespace mien::sample {

namespace {

struct Key {
  double seconds, value;
};

/// Keys of one shape.
struct ShapeLine {
  const char* shape;
  std::vector<Key> keys;
};
/// Turns of one joint in degrees about x (nod, open), y (towards its left) and z.
struct TurnKey {
  double seconds, x, y, z;
};
struct TurnLine {
  const char* joint;
  std::vector<TurnKey> keys;
};

constexpr double kLength = 4.0;

// "Hello -- nice to see you": h-e-l-ou  n-ai-s  t-u  s-ii  j-uu.
const ShapeLine kShapes[] = {
    {"mouthFunnel",
     {{0, 0},
      {0.75, 0},
      {0.95, 0.75},
      {1.15, 0.2},
      {1.3, 0},
      {1.95, 0},
      {2.1, 0.5},
      {2.3, 0},
      {2.95, 0},
      {3.15, 0.6},
      {3.4, 0},
      {4, 0}}},
    {"mouthPucker",
     {{0, 0},
      {0.8, 0},
      {1.05, 0.55},
      {1.25, 0},
      {2.0, 0},
      {2.15, 0.5},
      {2.3, 0},
      {2.95, 0},
      {3.2, 0.8},
      {3.5, 0},
      {4, 0}}},
    {"mouthSmileLeft",
     {{0, 0.1},
      {0.35, 0.25},
      {0.7, 0.05},
      {1.4, 0.2},
      {1.7, 0.45},
      {2.0, 0.1},
      {2.6, 0.55},
      {2.9, 0.2},
      {3.5, 0.6},
      {3.8, 0.45},
      {4, 0.1}}},
    {"mouthSmileRight",
     {{0, 0.1},
      {0.35, 0.22},
      {0.7, 0.05},
      {1.4, 0.2},
      {1.7, 0.4},
      {2.0, 0.1},
      {2.6, 0.5},
      {2.9, 0.2},
      {3.5, 0.7},
      {3.8, 0.5},
      {4, 0.1}}},
    {"mouthUpperUpLeft",
     {{0, 0}, {1.3, 0}, {1.55, 0.35}, {1.8, 0.2}, {2.0, 0}, {2.4, 0.1}, {2.6, 0.4}, {2.9, 0}, {4, 0}}},
    {"mouthUpperUpRight",
     {{0, 0}, {1.3, 0}, {1.55, 0.35}, {1.8, 0.2}, {2.0, 0}, {2.4, 0.1}, {2.6, 0.4}, {2.9, 0}, {4, 0}}},
    {"mouthLowerDownLeft",
     {{0, 0},
      {0.3, 0.3},
      {0.6, 0},
      {1.4, 0},
      {1.6, 0.45},
      {1.9, 0.1},
      {2.35, 0.1},
      {2.6, 0.5},
      {2.9, 0},
      {4, 0}}},
    {"mouthLowerDownRight",
     {{0, 0},
      {0.3, 0.3},
      {0.6, 0},
      {1.4, 0},
      {1.6, 0.45},
      {1.9, 0.1},
      {2.35, 0.1},
      {2.6, 0.5},
      {2.9, 0},
      {4, 0}}},
    {"eyeBlinkLeft",
     {{0, 0},
      {0.1, 0},
      {0.18, 1},
      {0.32, 0},
      {1.85, 0},
      {1.93, 1},
      {2.08, 0},
      {3.45, 0},
      {3.53, 1},
      {3.7, 0},
      {4, 0}}},
    {"eyeBlinkRight",
     {{0, 0},
      {0.1, 0},
      {0.18, 1},
      {0.32, 0},
      {1.85, 0},
      {1.93, 1},
      {2.08, 0},
      {3.45, 0},
      {3.53, 1},
      {3.7, 0},
      {4, 0}}},
    {"browInnerUp", {{0, 0}, {0.4, 0.5}, {1.0, 0.1}, {2.2, 0.1}, {2.5, 0.6}, {3.2, 0.2}, {4, 0}}},
    {"browOuterUpLeft", {{0, 0}, {0.4, 0.4}, {1.0, 0}, {2.3, 0}, {2.5, 0.5}, {3.2, 0}, {4, 0}}},
    {"browOuterUpRight", {{0, 0}, {0.4, 0.4}, {1.0, 0}, {2.3, 0}, {2.5, 0.4}, {3.2, 0}, {4, 0}}},
    {"cheekSquintLeft", {{0, 0}, {2.4, 0}, {2.7, 0.3}, {3.0, 0.1}, {3.5, 0.4}, {4, 0}}},
    {"cheekSquintRight", {{0, 0}, {2.4, 0}, {2.7, 0.3}, {3.0, 0.1}, {3.5, 0.4}, {4, 0}}},
};

const TurnLine kTurns[] = {
    {"jaw",
     {{0, 0, 0, 0},
      {0.25, 9, 0, 0},
      {0.5, 4, 0, 0},
      {0.8, 11, 0, 0},
      {1.1, 4, 0, 0},
      {1.3, 1.5, 0, 0},
      {1.55, 14, 0, 0},
      {1.8, 4, 0, 0},
      {1.95, 2, 0, 0},
      {2.1, 4, 0, 0},
      {2.35, 1.5, 0, 0},
      {2.6, 6, 0.6, 0},
      {2.9, 2.5, 0, 0},
      {3.15, 4, 0, 0},
      {3.5, 1, 0, 0},
      {4, 0, 0, 0}}},
    {"head",
     {{0, 0, 0, 0},
      {0.35, -4, 3, 1},
      {0.8, 3, 1, 0},
      {1.5, -2, -5, -2},
      {2.0, 3, -3, -1},
      {2.6, -3, 5, 3},
      {3.2, 3, 3, 2},
      {3.6, 1, 0, 0.5},
      {4, 0, 0, 0}}},
    {"neck", {{0, 0, 0, 0}, {0.5, -1, 2, 0}, {1.5, 1, -3, 0}, {2.6, -1, 3, 1}, {4, 0, 0, 0}}},
    {"eyeLeft_joint",
     {{0, 0, 0, 0},
      {0.35, 2, -3, 0},
      {1.2, 0, 0, 0},
      {1.5, 1, 5, 0},
      {2.0, -1, 3, 0},
      {2.6, 2, -5, 0},
      {3.2, -1, -3, 0},
      {4, 0, 0, 0}}},
    {"eyeRight_joint",
     {{0, 0, 0, 0},
      {0.35, 2, -3, 0},
      {1.2, 0, 0, 0},
      {1.5, 1, 5, 0},
      {2.0, -1, 3, 0},
      {2.6, 2, -5, 0},
      {3.2, -1, -3, 0},
      {4, 0, 0, 0}}},
    {"tongue2",
     {{0, 0, 0, 0},
      {0.5, 0, 0, 0},
      {0.62, -14, 0, 0},
      {0.75, 0, 0, 0},
      {1.3, -12, 0, 0},
      {1.45, 0, 0, 0},
      {1.95, -10, 0, 0},
      {2.1, 0, 0, 0},
      {4, 0, 0, 0}}},
};

Eigen::Quaterniond turned(const TurnKey& key) {
  const double degree = std::numbers::pi / 180;
  return Eigen::Quaterniond(Eigen::AngleAxisd(key.y * degree, Vector3d::UnitY()) *
                            Eigen::AngleAxisd(key.x * degree, Vector3d::UnitX()) *
                            Eigen::AngleAxisd(key.z * degree, Vector3d::UnitZ()));
}

}  // namespace

void add_talking_clip(Character& character) {
  Clip clip;
  clip.name = "talk";
  for (const ShapeLine& line : kShapes) {
    Channel channel;
    channel.property = Channel::Property::shape_weight;
    channel.shape = find_shape(character, line.shape);
    for (const Key& key : line.keys) {
      channel.times.push_back(static_cast<float>(key.seconds));
      channel.values.push_back(static_cast<float>(key.value));
    }
    clip.channels.push_back(channel);
  }
  for (const TurnLine& line : kTurns) {
    Channel channel;
    channel.property = Channel::Property::rotation;
    channel.node = find_node(character, line.joint);
    // In-between keys ease in and out where files of plain keys would turn corners.
    for (std::size_t k = 0; k < line.keys.size(); ++k) {
      const TurnKey &from = line.keys[k], &to = line.keys[std::min(k + 1, line.keys.size() - 1)];
      const int steps = k + 1 < line.keys.size() ? 4 : 1;
      for (int s = 0; s < steps; ++s) {
        const double t = double(s) / steps, ease = t * t * (3 - 2 * t);
        const Eigen::Quaterniond q = turned(from).slerp(ease, turned(to));
        channel.times.push_back(static_cast<float>(from.seconds + t * (to.seconds - from.seconds)));
        for (const double c : {q.x(), q.y(), q.z(), q.w()}) channel.values.push_back(static_cast<float>(c));
      }
    }
    clip.channels.push_back(channel);
  }
  // The whole head leans in at the end.
  Channel lean;
  lean.property = Channel::Property::translation;
  lean.node = find_node(character, "neck");
  const Vector3d rest = character.nodes[lean.node].rest.translation;
  for (const Key& key : {Key{0, 0}, Key{2.2, 0}, Key{2.7, 0.8}, Key{3.4, 0.6}, Key{kLength, 0}}) {
    lean.times.push_back(static_cast<float>(key.seconds));
    for (const double c : {rest.x(), rest.y() - 0.2 * key.value, rest.z() + key.value})
      lean.values.push_back(static_cast<float>(c));
  }
  clip.channels.push_back(lean);
  character.clips.push_back(clip);
}

}  // namespace mien::sample
