#pragma once
/// Where a glTF's uri points: a data: URI or a file beside the glTF.

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace mien::detail {

/// The bytes behind a uri; a relative path is percent-decoded and looked up in `folder`.
///   throws  io at `place`: another scheme, an absolute path, a path with "..", a missing file, broken base64
std::vector<std::uint8_t> read_uri(std::string_view uri, const std::filesystem::path& folder,
                                   const std::string& place);

/// Whether a relative uri names an existing file inside `folder`.
bool uri_exists(std::string_view uri, const std::filesystem::path& folder);

/// A file name as a uri: everything but letters, digits and "-._~" percent-encoded.
std::string encode_uri(std::string_view name);

/// The media type in a data: URI, or an empty text.
std::string media_type_of(std::string_view uri);

}  // namespace mien::detail
