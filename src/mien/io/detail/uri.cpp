#include "mien/io/detail/uri.h"

#include <fmt/format.h>

#include <cctype>
#include <optional>

#include "mien/core/error.h"
#include "mien/io/file.h"

namespace mien::detail {
namespace {

int hex_digit(char c) {
  if (c >= '0' && c <= '9') return c - '0';
  if (c >= 'a' && c <= 'f') return c - 'a' + 10;
  if (c >= 'A' && c <= 'F') return c - 'A' + 10;
  return -1;
}

std::string percent_decoded(std::string_view text) {
  std::string result;
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (text[i] == '%' && i + 2 < text.size() && hex_digit(text[i + 1]) >= 0 && hex_digit(text[i + 2]) >= 0) {
      result += static_cast<char>(hex_digit(text[i + 1]) * 16 + hex_digit(text[i + 2]));
      i += 2;
    } else {
      result += text[i];
    }
  }
  return result;
}

int base64_digit(char c) {
  if (c >= 'A' && c <= 'Z') return c - 'A';
  if (c >= 'a' && c <= 'z') return c - 'a' + 26;
  if (c >= '0' && c <= '9') return c - '0' + 52;
  if (c == '+' || c == '-') return 62;
  if (c == '/' || c == '_') return 63;
  return -1;
}

std::vector<std::uint8_t> base64_decoded(std::string_view text, const std::string& place) {
  while (text.ends_with('=')) text.remove_suffix(1);
  std::vector<std::uint8_t> bytes;
  bytes.reserve(text.size() * 3 / 4);
  std::uint32_t bits = 0;
  int held = 0;
  for (const char c : text) {
    const int digit = base64_digit(c);
    if (digit < 0) throw io_error(place, "is not valid base64", "check the data: URI");
    bits = (bits << 6 | static_cast<std::uint32_t>(digit)) & 0xFFFFFF;
    held += 6;
    if (held >= 8) bytes.push_back(static_cast<std::uint8_t>(bits >> (held -= 8)));
  }
  return bytes;
}

/// The file inside the folder that a relative uri names; nothing when it is of another kind or leaves the
/// folder.
std::optional<std::filesystem::path> inside(std::string_view uri, const std::filesystem::path& folder) {
  const std::string name = percent_decoded(uri);
  if (name.empty() || name.find('\0') != name.npos || name.find("://") != name.npos) return std::nullopt;
  const std::filesystem::path path(name);
  if (path.is_absolute()) return std::nullopt;
  for (const auto& step : path)
    if (step == "..") return std::nullopt;
  return folder / path;
}

}  // namespace

std::vector<std::uint8_t> read_uri(std::string_view uri, const std::filesystem::path& folder,
                                   const std::string& place) {
  if (uri.starts_with("data:")) {
    const std::size_t comma = uri.find(',');
    if (comma == uri.npos) throw io_error(place, "is a data: URI without data", "check the file");
    if (!uri.substr(0, comma).ends_with(";base64"))
      throw io_error(place, "is a data: URI that is not base64", "encode it as base64");
    return base64_decoded(uri.substr(comma + 1), place);
  }
  const auto path = inside(uri, folder);
  if (!path)
    throw io_error(place, fmt::format("names \"{}\"", uri.substr(0, 200)),
                   "name a file in the glTF's folder");
  if (!std::filesystem::is_regular_file(*path))
    throw io_error(place, fmt::format("names \"{}\", which does not exist", uri.substr(0, 200)),
                   "keep the files beside each other");
  return read_file(*path);
}

bool uri_exists(std::string_view uri, const std::filesystem::path& folder) {
  if (uri.starts_with("data:")) return true;
  const auto path = inside(uri, folder);
  std::error_code ignored;
  return path && std::filesystem::is_regular_file(*path, ignored);
}

std::string encode_uri(std::string_view name) {
  std::string result;
  for (const char c : name) {
    const auto byte = static_cast<unsigned char>(c);
    if (std::isalnum(byte) || c == '-' || c == '.' || c == '_' || c == '~')
      result += c;
    else
      result += fmt::format("%{:02X}", byte);
  }
  return result;
}

std::string media_type_of(std::string_view uri) {
  if (!uri.starts_with("data:")) return {};
  return std::string(uri.substr(5, uri.find_first_of(";,") - 5));
}

}  // namespace mien::detail
