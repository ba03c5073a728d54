#include "mien/transfer/detail/piece_kinds.h"

#include <algorithm>
#include <array>
#include <cctype>

#include "mien/transfer/detail/at.h"

namespace mien::detail {
namespace {

std::string lower(std::string text) {
  for (char& c : text) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return text;
}

bool has(const std::string& text, std::initializer_list<const char*> words) {
  return std::any_of(words.begin(), words.end(),
                     [&](const char* w) { return text.find(w) != std::string::npos; });
}

/// A ball: distances from the centre of the box differ little. Half-balls and eyes with a cornea pass.
bool is_ball(const PointsD& points, double unit) {
  const Eigen::RowVector3d low = points.colwise().minCoeff(), high = points.colwise().maxCoeff();
  const Eigen::RowVector3d size = high - low;
  if (points.rows() < 20 || size.maxCoeff() > 0.5 * unit || size.minCoeff() < 0.6 * size.maxCoeff())
    return false;
  const Eigen::VectorXd radius = (points.rowwise() - (low + high) / 2).rowwise().norm();
  return radius.minCoeff() > 0.7 * radius.maxCoeff();
}

}  // namespace

bool is_lash(const std::string& name) {
  return has(lower(name), {"lash"});
}

int row_from_name(const std::string& name) {
  const std::string n = lower(name);
  return has(n, {"upper", "top"}) ? 1 : has(n, {"lower", "bottom"}) ? -1 : 0;
}

PieceKind kind_from_name(const std::string& name) {
  // Of "part: group" the group knows better: a part of eyes and lashes has groups of either.
  const std::size_t colon = name.rfind(": ");
  if (colon != std::string::npos) {
    const PieceKind group = kind_from_name(name.substr(colon + 2));
    return group != PieceKind::other ? group : kind_from_name(name.substr(0, colon));
  }
  const std::string n = lower(name);
  if (has(n, {"lash", "brow", "beard", "hair", "mustache", "moustache"})) return PieceKind::lash;
  if (has(n, {"teeth", "tooth", "gum", "denture"})) return PieceKind::teeth;
  if (has(n, {"tongue"})) return PieceKind::tongue;
  if (has(n, {"eye", "cornea", "iris", "pupil", "sclera"}) && !has(n, {"lid"})) return PieceKind::eye;
  return PieceKind::other;
}

PieceKind kind_of(const Pool& pool, int piece, double unit) {
  const PieceKind named = kind_from_name(pool.piece_name[at(piece)]);
  if (named != PieceKind::other) return named;
  return is_ball(pool.positions(vertices_of(pool, piece), Eigen::all), unit) ? PieceKind::eye
                                                                             : PieceKind::other;
}

std::string_view name_of(PieceKind kind) {
  constexpr std::array<std::string_view, 6> names{"skin", "eye", "teeth", "tongue", "lash", "other"};
  return names[static_cast<std::size_t>(kind)];
}

}  // namespace mien::detail
