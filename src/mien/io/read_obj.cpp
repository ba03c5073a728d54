#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "mien/core/error.h"
#include "mien/io/file.h"
#include "mien/io/obj.h"

// One pass over the bytes; everything that grows is reserved from the file's size. Most of the time goes into numbers: plain
// decimals and indices take paths of their own, exact as from_chars is, eight digits at a time.

namespace mien {
namespace {

/// Each is exact in a double too.
constexpr std::array<std::uint64_t, 17> powers_of_ten = [] {
  std::array<std::uint64_t, 17> powers{1};
  for (std::size_t p = 1; p < powers.size(); ++p) powers[p] = 10 * powers[p - 1];
  return powers;
}();

struct Digits {
  std::uint64_t value = 0;
  int count = 0;
};

/// The digits that `at` begins with, eight at most; eight bytes must be there. All eight at once: each byte's digit, then pairs,
/// fours and the whole (Lemire 2018).
Digits leading_digits(const char* at) {
  static_assert(std::endian::native == std::endian::little);
  std::uint64_t bytes;
  std::memcpy(&bytes, at, sizeof bytes);
  const std::uint64_t digits = bytes ^ 0x3030303030303030;
  const std::uint64_t others = ((digits + 0x7676767676767676) | digits) & 0x8080808080808080;
  const int count = others ? std::countr_zero(others) / 8 : 8;
  if (count == 0) return {};
  std::uint64_t pairs = digits << (64 - 8 * count);  // zeros in front
  pairs = pairs * 10 + (pairs >> 8);
  constexpr std::uint64_t every_fourth = 0x000000FF000000FF;
  const std::uint64_t value = ((pairs & every_fourth) * (100 + (1000000ULL << 32)) +
                               ((pairs >> 16) & every_fourth) * (1 + (10000ULL << 32))) >>
                              32;
  return {value, count};
}

/// Reads digits[.digits] of at most 15 digits, behind which a blank or a line's end must be: the float nearest to it, and where
/// it ends; nullptr for everything else. Digits and power are exact in double, so their quotient is the nearest double; only one
/// next to the middle of two floats could round to the wrong one of them, and that one is left to the slow path.
const char* read_plain_decimal(const char* at, const char* end, float& value) {
  if (end - at < 32) return nullptr;
  const bool negative = *at == '-';
  at += negative;
  Digits number = leading_digits(at);
  at += number.count;
  int after = 0;
  if (*at == '.') {
    for (int turn = 0; turn < 2; ++turn) {
      const Digits more = leading_digits(at + 1 + after);
      number.value = number.value * powers_of_ten[static_cast<std::size_t>(more.count)] + more.value;
      number.count += more.count;
      after += more.count;
      if (more.count < 8) break;
    }
    at += 1 + after;
  }
  if (number.count == 0 || number.count > 15 || static_cast<unsigned char>(*at) > ' ') return nullptr;
  const double exact =
      static_cast<double>(number.value) / static_cast<double>(powers_of_ten[static_cast<std::size_t>(after)]);
  const std::uint64_t beyond_float = std::bit_cast<std::uint64_t>(exact) & 0x1FFFFFFF;
  if (beyond_float - 0x0FFFFFFF <= 2) return nullptr;
  value = static_cast<float>(negative ? -exact : exact);
  return at;
}

/// One face corner as the file numbers it, from 0; -1: not given.
struct Corner {
  int vertex = -1, uv = -1, normal = -1;
};

/// Whether a number that no float holds is too small rather than too large.
bool is_tiny(std::string_view number) {
  const std::size_t exponent = number.find_first_of("eE");
  if (exponent != number.npos) return number.substr(exponent + 1).starts_with('-');
  const std::size_t point = number.find('.');
  return number.find_first_of("123456789") > point;
}

class ObjReader {
 public:
  explicit ObjReader(std::string_view text) : at_(text.data()), end_(text.data() + text.size()) {}
  Character read(const std::string& name);

 private:
  void read_line();
  void read_vertex();
  void read_face();
  std::optional<Corner> read_corner();
  int read_index(std::size_t count, const char* kind, int& furthest, int& furthest_line);
  float read_number(const char* what);
  std::optional<float> next_number();
  std::string_view rest_of_line();
  void begin_group();
  void skip_blanks();
  void skip_line();
  bool at_line_end() const { return at_ == end_ || *at_ == '\n' || *at_ == '\r' || *at_ == '#'; }
  Error wrong(std::string_view problem, std::string_view remedy) const {
    return io_error(fmt::format("line {}", line_), problem, remedy);
  }
  void check_range(int furthest, int line, std::size_t count, const char* kind) const;
  void set_uvs(Mesh& mesh);
  void set_normals(Mesh& mesh) const;

  const char *at_, *end_;
  int line_ = 1;
  std::vector<float> positions_, uvs_, normals_, colors_;
  Faces faces_;
  std::vector<int> face_, uv_corners_, normal_corners_;
  std::vector<FaceGroup> groups_;
  std::string object_, group_;
  int material_ = -1;
  bool group_changed_ = false, any_group_ = false;
  std::vector<std::string> materials_;
  std::map<std::string, int, std::less<>> material_numbers_;
  int furthest_vertex_ = -1, furthest_vertex_line_ = 0, furthest_uv_ = -1, furthest_uv_line_ = 0;
  int furthest_normal_ = -1, furthest_normal_line_ = 0;
};

/// Also steps over a backslash at a line's end, which continues the line.
void ObjReader::skip_blanks() {
  for (; at_ < end_; ++at_) {
    if (*at_ == ' ' || *at_ == '\t') continue;
    if (*at_ != '\\') return;
    const char* next = at_ + 1;
    if (next < end_ && *next == '\r') ++next;
    if (next >= end_ || *next != '\n') return;
    at_ = next;
    ++line_;
  }
}

void ObjReader::skip_line() {
  if (at_ < end_ && *at_ == '\n') {
    ++at_, ++line_;
    return;
  }
  const void* newline = std::memchr(at_, '\n', static_cast<std::size_t>(end_ - at_));
  const char* stop = newline ? static_cast<const char*>(newline) : end_;
  const char* last = stop > at_ && stop[-1] == '\r' ? stop - 1 : stop;
  const bool continues = newline && last > at_ && last[-1] == '\\';
  at_ = newline ? stop + 1 : end_;
  ++line_;
  if (continues) skip_line();
}

std::string_view ObjReader::rest_of_line() {
  skip_blanks();
  const char* first = at_;
  while (at_ < end_ && *at_ != '\n' && *at_ != '\r') ++at_;
  std::string_view rest(first, static_cast<std::size_t>(at_ - first));
  while (!rest.empty() && (rest.back() == ' ' || rest.back() == '\t')) rest.remove_suffix(1);
  return rest;
}

std::optional<float> ObjReader::next_number() {
  skip_blanks();
  if (at_line_end()) return std::nullopt;
  float value = 0;
  if (const char* after = read_plain_decimal(at_, end_, value)) {
    at_ = after;
    return value;
  }
  if (*at_ == '+') ++at_;
  const auto [after, code] = std::from_chars(at_, end_, value);
  if (code == std::errc::result_out_of_range) {
    if (!is_tiny(std::string_view(at_, static_cast<std::size_t>(after - at_))))
      throw wrong("has a number that is too large", "give numbers that a float can hold");
    value = 0;
  } else if (code != std::errc() || !std::isfinite(value)) {
    const char* stop = at_;
    while (stop < end_ && stop - at_ < 20 && static_cast<unsigned char>(*stop) > ' ') ++stop;
    throw wrong(fmt::format("has \"{}\"", std::string_view(at_, static_cast<std::size_t>(stop - at_))),
                "give a finite number");
  }
  at_ = after;
  if (at_<end_&& static_cast<unsigned char>(*at_)> ' ' && *at_ != '\\' && *at_ != '#')
    throw wrong(fmt::format("has \"{}\" after a number", *at_), "separate numbers by blanks");
  return value;
}

float ObjReader::read_number(const char* what) {
  const std::optional<float> number = next_number();
  if (!number) throw wrong("ends too early", fmt::format("give {}", what));
  return *number;
}

void ObjReader::read_vertex() {
  for (int k = 0; k < 3; ++k) positions_.push_back(read_number("x, y and z"));
  float more[4];
  int count = 0;
  while (count < 4) {
    const std::optional<float> number = next_number();
    if (!number) break;
    more[count++] = *number;
  }
  if (count < 3) return;  // nothing, or w
  colors_.resize((positions_.size() / 3 - 1) * 3, 1.f);
  const float* color = more + (count == 4 ? 1 : 0);
  colors_.insert(colors_.end(), color, color + 3);
}

/// Numbers from 1, or from -1 back; what lies ahead in the file is checked at its end.
int ObjReader::read_index(std::size_t count, const char* kind, int& furthest, int& furthest_line) {
  if (end_ - at_ >= 8) {
    const Digits digits = leading_digits(at_);
    if (digits.value > 0 && digits.count < 8) {
      at_ += digits.count;
      const int plain = static_cast<int>(digits.value) - 1;
      if (plain > furthest) furthest = plain, furthest_line = line_;
      return plain;
    }
  }
  constexpr long long limit = 2'000'000'000;
  const bool negative = at_ < end_ && *at_ == '-';
  if (at_ < end_ && (*at_ == '+' || *at_ == '-')) ++at_;
  const char* first = at_;
  long long number = 0;
  for (; at_ < end_ && *at_ >= '0' && *at_ <= '9'; ++at_)
    number = std::min(number * 10 + (*at_ - '0'), limit + 1);
  if (at_ == first)
    throw wrong(fmt::format("has a face corner without a {} number", kind), "give v, v/vt, v//vn or v/vt/vn");
  const bool huge = number > limit;
  if (negative) number = -number;
  const long long index = number > 0 ? number - 1 : number + static_cast<long long>(count);
  if (huge || number == 0 || index < 0)
    throw wrong(fmt::format("names {} {}", kind, huge ? "far out of range" : std::to_string(number)),
                fmt::format("there are {} so far", count));
  if (index > furthest) furthest = static_cast<int>(index), furthest_line = line_;
  return static_cast<int>(index);
}

std::optional<Corner> ObjReader::read_corner() {
  skip_blanks();
  if (at_line_end()) return std::nullopt;
  Corner corner;
  corner.vertex = read_index(positions_.size() / 3, "vertex", furthest_vertex_, furthest_vertex_line_);
  const auto slash = [&] { return at_ < end_ && *at_ == '/' ? (++at_, true) : false; };
  if (!slash()) return corner;
  const auto blank = [&] { return at_ == end_ || static_cast<unsigned char>(*at_) <= ' '; };
  if (at_ < end_ && *at_ != '/' && !blank())
    corner.uv = read_index(uvs_.size() / 2, "texture coordinate", furthest_uv_, furthest_uv_line_);
  if (slash() && !blank())
    corner.normal = read_index(normals_.size() / 3, "normal", furthest_normal_, furthest_normal_line_);
  return corner;
}

void ObjReader::begin_group() {
  if (!group_changed_ && !groups_.empty()) return;
  group_changed_ = false;
  FaceGroup group;
  group.name = group_.empty() ? object_ : group_;
  group.material = material_;
  group.face_begin = group.face_end = static_cast<int>(faces_.size());
  const bool same =
      !groups_.empty() && groups_.back().name == group.name && groups_.back().material == group.material;
  if (!same) groups_.push_back(std::move(group));
}

void ObjReader::read_face() {
  begin_group();
  face_.clear();
  while (const std::optional<Corner> corner = read_corner()) {
    face_.push_back(corner->vertex);
    uv_corners_.push_back(corner->uv);
    normal_corners_.push_back(corner->normal);
  }
  if (face_.size() < 3)
    throw wrong(fmt::format("has a face of {} corners", face_.size()), "give three or more");
  faces_.push_back(face_);
  groups_.back().face_end = static_cast<int>(faces_.size());
}

void ObjReader::read_line() {
  skip_blanks();
  const char* first = at_;
  while (at_<end_&& static_cast<unsigned char>(*at_)> ' ' && *at_ != '\\') ++at_;
  const std::string_view word(first, static_cast<std::size_t>(at_ - first));
  if (word == "v") {
    read_vertex();
  } else if (word == "vt") {
    uvs_.push_back(read_number("u"));
    uvs_.push_back(next_number().value_or(0.f));
  } else if (word == "vn") {
    for (int k = 0; k < 3; ++k) normals_.push_back(read_number("x, y and z"));
  } else if (word == "f") {
    read_face();
  } else if (word == "g" || word == "o") {
    (word == "g" ? group_ : object_) = rest_of_line();
    if (word == "o") group_.clear();
    group_changed_ = any_group_ = true;
  } else if (word == "usemtl") {
    const auto [known, is_new] =
        material_numbers_.emplace(rest_of_line(), static_cast<int>(materials_.size()));
    if (is_new) materials_.push_back(known->first);
    material_ = known->second;
    group_changed_ = any_group_ = true;
  }
  skip_line();
}

void ObjReader::check_range(int furthest, int line, std::size_t count, const char* kind) const {
  if (furthest >= static_cast<long long>(count))
    throw io_error(fmt::format("line {}", line), fmt::format("names {} {}", kind, furthest + 1LL),
                   fmt::format("the file has {}", count));
}

void ObjReader::set_uvs(Mesh& mesh) {
  if (std::all_of(uv_corners_.begin(), uv_corners_.end(), [](int uv) { return uv < 0; })) return;
  UvSet uv;
  uv.coordinates = Eigen::Map<const Points2>(uvs_.data(), static_cast<Eigen::Index>(uvs_.size() / 2), 2);
  const bool by_vertex = uv.coordinates.rows() == mesh.positions.rows() && uv_corners_ == faces_.corners();
  if (!by_vertex) uv.corners = std::move(uv_corners_);
  mesh.uvs.push_back(std::move(uv));
}

void ObjReader::set_normals(Mesh& mesh) const {
  const Eigen::Map<const Points> normals(normals_.data(), static_cast<Eigen::Index>(normals_.size() / 3), 3);
  std::vector<int> of_vertex(mesh.vertex_count(), -1);
  for (std::size_t c = 0; c < normal_corners_.size(); ++c) {
    int& known = of_vertex[faces_.corners()[c]];
    const int normal = normal_corners_[c];
    if (normal < 0) return;
    if (known >= 0 && known != normal && normals.row(known) != normals.row(normal)) return;
    if (known < 0) known = normal;
  }
  Points rows = Points::Zero(mesh.positions.rows(), 3);
  for (std::size_t v = 0; v < of_vertex.size(); ++v) {
    const int normal = of_vertex[v];
    if (normal < 0) continue;
    const float length = normals.row(normal).norm();
    if (!(length > 0)) return;
    rows.row(v) = normals.row(normal);
    if (std::abs(length - 1) > 1e-4f) rows.row(v) /= length;
  }
  mesh.normals = std::move(rows);
}

Character ObjReader::read(const std::string& name) {
  const auto size = static_cast<std::size_t>(end_ - at_);
  positions_.reserve(size / 24);
  uv_corners_.reserve(size / 16);
  normal_corners_.reserve(size / 16);
  faces_.reserve(size / 64, size / 16);
  if (size >= 3 && std::memcmp(at_, "\xEF\xBB\xBF", 3) == 0) at_ += 3;
  while (at_ < end_) read_line();
  if (positions_.empty()) throw io_error("file", "has no vertices", "give an OBJ with v lines");
  check_range(furthest_vertex_, furthest_vertex_line_, positions_.size() / 3, "vertex");
  check_range(furthest_uv_, furthest_uv_line_, uvs_.size() / 2, "texture coordinate");
  check_range(furthest_normal_, furthest_normal_line_, normals_.size() / 3, "normal");
  Character character;
  Part part;
  part.name = name;
  Mesh& mesh = part.mesh;
  mesh.positions =
      Eigen::Map<const Points>(positions_.data(), static_cast<Eigen::Index>(positions_.size() / 3), 3);
  set_uvs(mesh);
  if (!normals_.empty() && !normal_corners_.empty()) set_normals(mesh);
  if (!colors_.empty()) {
    colors_.resize(positions_.size(), 1.f);
    mesh.colors.push_back(Points4::Ones(mesh.positions.rows(), 4));
    mesh.colors[0].leftCols<3>() = Eigen::Map<const Points>(colors_.data(), mesh.positions.rows(), 3);
  }
  mesh.faces = std::move(faces_);
  if (any_group_) mesh.groups = std::move(groups_);
  for (FaceGroup& group : mesh.groups) group.vertex_end = static_cast<int>(mesh.vertex_count());
  for (const std::string& material : materials_) {
    character.appearance.materials.emplace_back();
    character.appearance.materials.back().name = material;
  }
  character.parts.push_back(std::move(part));
  return character;
}

}  // namespace

Character read_obj(const std::filesystem::path& path) {
  try {
    const std::vector<std::uint8_t> bytes = read_file(path);
    if (bytes.empty()) throw io_error("file", "is empty", "give an OBJ with v lines");
    return ObjReader({reinterpret_cast<const char*>(bytes.data()), bytes.size()}).read(path.stem().string());
  } catch (const Error& error) {
    throw error.in_file(path.string());
  }
}

}  // namespace mien
