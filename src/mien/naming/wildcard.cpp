// One star at a time: when what follows a star does not fit, only the last star has to give way (an earlier one that is shorter leaves
// more to the later ones), so that no pattern takes exponential time.
#include "mien/naming/wildcard.h"

#include <cctype>

namespace mien {
namespace {

bool same_letter(char a, char b) {
  return std::tolower(static_cast<unsigned char>(a)) == std::tolower(static_cast<unsigned char>(b));
}

struct Span {
  std::size_t begin = 0, end = 0;
};

}  // namespace

std::optional<std::vector<std::string>> match_wildcards(std::string_view pattern, std::string_view name) {
  std::vector<Span> spans;  // of each wildcard, in the name
  std::size_t p = 0, n = 0, star = pattern.npos, spans_at_star = 0;
  while (n < name.size() || p < pattern.size()) {
    if (p < pattern.size() && pattern[p] == '*') {
      star = p++;
      spans.push_back({n, n});
      spans_at_star = spans.size();
    } else if (p < pattern.size() && n < name.size() &&
               (pattern[p] == '?' || same_letter(pattern[p], name[n]))) {
      if (pattern[p] == '?') spans.push_back({n, n + 1});
      ++p;
      ++n;
    } else if (star != pattern.npos && spans[spans_at_star - 1].end < name.size()) {
      spans.resize(spans_at_star);
      n = ++spans.back().end;
      p = star + 1;
    } else {
      return std::nullopt;
    }
  }
  std::vector<std::string> fillings;
  for (const Span& span : spans) fillings.emplace_back(name.substr(span.begin, span.end - span.begin));
  return fillings;
}

bool fits_wildcards(std::string_view pattern, std::string_view name) {
  return match_wildcards(pattern, name).has_value();
}

std::string fill_wildcards(std::string_view pattern, const std::vector<std::string>& fillings) {
  std::string name;
  std::size_t next = 0;
  for (const char c : pattern) {
    if (c != '*' && c != '?')
      name += c;
    else if (next < fillings.size())
      name += fillings[next++];
  }
  return name;
}

}  // namespace mien
