// How names say which side they are of. A name is cut into words at separators and where camel case starts a new one;
// a side is the word left or right anywhere, or l or r first or last.
#include <algorithm>
#include <cctype>
#include <optional>
#include <string>
#include <vector>

#include "mien/naming/action.h"
#include "mien/naming/detail/tables.h"

namespace mien {
namespace {

struct Word {
  std::size_t begin = 0, size = 0;
};

bool is_letter_or_digit(char c) {
  return std::isalnum(static_cast<unsigned char>(c)) != 0;
}
bool is_upper(char c) {
  return std::isupper(static_cast<unsigned char>(c)) != 0;
}
bool is_lower(char c) {
  return std::islower(static_cast<unsigned char>(c)) != 0;
}

std::vector<Word> words_of(std::string_view name) {
  std::vector<Word> words;
  for (std::size_t i = 0; i < name.size(); ++i) {
    if (!is_letter_or_digit(name[i])) continue;
    const bool starts =
        i == 0 || !is_letter_or_digit(name[i - 1]) || (is_upper(name[i]) && is_lower(name[i - 1]));
    if (starts)
      words.push_back({i, 1});
    else
      ++words.back().size;
  }
  return words;
}

std::string lower(std::string_view text) {
  std::string result(text);
  std::transform(result.begin(), result.end(), result.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return result;
}

char side_of(const std::string& word, bool outermost) {
  if (word == "left" || (outermost && word == "l")) return 'L';
  if (word == "right" || (outermost && word == "r")) return 'R';
  return 0;
}

/// The word that tells the side: the last one that can.
std::optional<Word> side_word(std::string_view name, const std::vector<Word>& words) {
  std::optional<Word> found;
  for (std::size_t w = 0; w < words.size(); ++w)
    if (words.size() > 1 &&
        side_of(lower(name.substr(words[w].begin, words[w].size)), w == 0 || w + 1 == words.size()) != 0)
      found = words[w];
  return found;
}

/// "AU12L", "AU12r": the usual way to write a FACS side.
std::optional<Word> facs_side(std::string_view name) {
  if (name.size() < 4 || lower(name.substr(0, 2)) != "au") return {};
  const char before = name[name.size() - 2];
  if (std::isdigit(static_cast<unsigned char>(before)) == 0 ||
      side_of(lower(name.substr(name.size() - 1)), true) == 0)
    return {};
  return Word{name.size() - 1, 1};
}

std::optional<Word> find_side(std::string_view name) {
  if (const auto facs = facs_side(name)) return facs;
  return side_word(name, words_of(name));
}

/// The opposite word in the same case.
std::string opposite(std::string_view word) {
  const std::string plain = lower(word);
  std::string other = plain == "left" ? "right" : plain == "right" ? "left" : plain == "l" ? "r" : "l";
  const bool all_upper = std::all_of(word.begin(), word.end(), is_upper);
  for (std::size_t i = 0; i < other.size(); ++i)
    if (all_upper || (i == 0 && is_upper(word[0])))
      other[i] = static_cast<char>(std::toupper(static_cast<unsigned char>(other[i])));
  return other;
}

}  // namespace

namespace detail {

PlainName plain_name(std::string_view name) {
  PlainName plain;
  const std::optional<Word> side = find_side(name);
  for (std::size_t i = 0; i < name.size(); ++i) {
    if (side && i == side->begin) {
      plain.side = side_of(lower(name.substr(side->begin, side->size)), true);
      i += side->size - 1;
    } else if (is_letter_or_digit(name[i])) {
      plain.base += static_cast<char>(std::tolower(static_cast<unsigned char>(name[i])));
    }
  }
  // AU01 is AU1.
  if (plain.base.starts_with("au0") && plain.base.size() > 3) plain.base.erase(2, 1);
  return plain;
}

}  // namespace detail

std::string bare_name(std::string_view name) {
  const std::size_t space = name.find_last_of(":|");
  if (space != name.npos) name.remove_prefix(space + 1);
  std::string bare = lower(name);
  std::erase_if(bare, [](char c) { return !is_letter_or_digit(c); });
  return bare;
}

Side side_of_name(std::string_view name) {
  const std::optional<Word> side = find_side(name);
  if (!side) return Side::none;
  return side_of(lower(name.substr(side->begin, side->size)), true) == 'L' ? Side::left : Side::right;
}

std::string mirrored_name(std::string_view name) {
  const std::optional<Word> side = find_side(name);
  if (!side) return {};
  std::string mirrored(name);
  return mirrored.replace(side->begin, side->size, opposite(name.substr(side->begin, side->size)));
}

}  // namespace mien
