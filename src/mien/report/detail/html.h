#pragma once
/// Pieces of a page.

#include <string>
#include <string_view>
#include <vector>

#include "mien/picture/picture.h"

namespace mien::detail {

/// Text that is safe between tags and in quoted attributes; bytes that are not UTF-8 and control characters become
/// U+FFFD.
std::string escaped(std::string_view text);

/// RFC 4648, with padding.
std::string base64(const std::vector<unsigned char>& bytes);

/// An <img> with the picture inside; `alt` is plain text.
std::string image(const Picture& picture, std::string_view alt);

/// A <figure> of one image; `caption` is markup.
std::string figure(const Picture& picture, std::string_view alt, const std::string& caption);

/// A <table>: cells are markup; the first column is a heading. Numbers are set in columns after the first.
std::string table(const std::vector<std::string>& head, const std::vector<std::vector<std::string>>& rows);

/// A whole document around `body`.
std::string document(std::string_view title, const std::string& body);

}  // namespace mien::detail
