#include "mien/picture/region.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cstdlib>
#include <span>
#include <string>

#include "mien/character/shown_parts.h"
#include "mien/core/error.h"

namespace mien {
namespace {

using Rows = std::vector<Eigen::Vector3d>;

std::string lower(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(), [](unsigned char c) { return std::tolower(c); });
  return text;
}

bool names_one(const std::string& name, std::span<const std::string_view> tokens) {
  const std::string low = lower(name);
  return std::any_of(tokens.begin(), tokens.end(),
                     [&](std::string_view token) { return low.find(token) != std::string::npos; });
}

struct Tokens {
  std::span<const std::string_view> landmarks, shapes, parts;
  int ibug_first, ibug_last;  // of the 68 points of iBUG, from 1
};

constexpr std::array<std::string_view, 2> mouth_landmarks{"mouth", "lip"}, eye_landmarks{"eye", "lid"};
constexpr std::array<std::string_view, 4> mouth_shapes{"mouthsmile", "mouthpucker", "mouthfunnel", "lip"};
constexpr std::array<std::string_view, 2> eye_shapes{"blink", "lid"};
constexpr std::array<std::string_view, 2> mouth_parts{"teeth", "tongue"};
constexpr std::array<std::string_view, 1> eye_parts{"eye"};

Tokens tokens_of(Region region) {
  if (region == Region::mouth) return {mouth_landmarks, mouth_shapes, mouth_parts, 49, 68};
  return {eye_landmarks, eye_shapes, eye_parts, 37, 48};
}

bool is_brow(const std::string& name) {
  return lower(name).find("brow") != std::string::npos;
}

bool is_ibug(const std::string& name, const Tokens& tokens) {
  if (name.rfind("ibug_", 0) != 0 || name.size() > 7) return false;
  const int number = std::atoi(name.c_str() + 5);
  return number >= tokens.ibug_first && number <= tokens.ibug_last;
}

Rows by_landmarks(const Character& character, const std::vector<Points>& posed, const Tokens& tokens) {
  Rows rows;
  for (const Landmark& landmark : character.landmarks)
    if (is_ibug(landmark.name, tokens) ||
        (names_one(landmark.name, tokens.landmarks) && !is_brow(landmark.name)))
      rows.push_back(
          position_of(character.parts[landmark.at.part].mesh, posed[landmark.at.part], landmark.at));
  return rows;
}

void add_most_moved(const PartDelta& delta, const Points& positions, Rows& rows) {
  const auto lengths = delta.deltas.rowwise().norm();
  const float most = delta.deltas.rows() > 0 ? lengths.maxCoeff() : 0;
  for (std::size_t i = 0; i < delta.vertices.size(); ++i)
    if (lengths[static_cast<Eigen::Index>(i)] > 0.65f * most)
      rows.push_back(positions.row(delta.vertices[i]).cast<double>());
}

Rows by_shapes(const Character& character, const std::vector<Points>& posed, const Tokens& tokens) {
  Rows rows;
  for (const Shape& shape : character.shapes)
    if (names_one(shape.name, tokens.shapes))
      for (const PartDelta& delta : shape.parts)
        if (character.parts[delta.part].shown) add_most_moved(delta, posed[delta.part], rows);
  return rows;
}

Rows by_parts(const Character& character, const std::vector<Points>& posed, const Tokens& tokens) {
  Rows rows;
  for (std::size_t p = 0; p < shown_part_count(character); ++p)
    if (names_one(character.parts[p].name, tokens.parts) && !is_brow(character.parts[p].name))
      for (Eigen::Index v = 0; v < posed[p].rows(); ++v) rows.push_back(posed[p].row(v).cast<double>());
  return rows;
}

}  // namespace

Region region_of_name(std::string_view name) {
  if (name == "mouth") return Region::mouth;
  if (name == "eyes") return Region::eyes;
  throw invalid_input("region " + std::string(name), "does not exist", "mouth or eyes");
}

std::optional<Box> find_region(const Character& character, const std::vector<Points>& posed, Region region) {
  const Tokens tokens = tokens_of(region);
  for (const auto find : {by_landmarks, by_shapes, by_parts}) {
    const Rows rows = find(character, posed, tokens);
    if (rows.size() < 2) continue;
    Box box{rows[0], rows[0]};
    for (const Eigen::Vector3d& row : rows) {
      box.low = box.low.cwiseMin(row);
      box.high = box.high.cwiseMax(row);
    }
    const double room = 0.12 * box.diagonal();
    box.low.array() -= room;
    box.high.array() += room;
    return box;
  }
  return std::nullopt;
}

}  // namespace mien
