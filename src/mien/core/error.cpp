#include "mien/core/error.h"

namespace mien {
namespace {

std::string one_line(std::string_view place, std::string_view problem, std::string_view remedy) {
  std::string text;
  if (!place.empty()) text.append(place).append(": ");
  text.append(problem);
  if (!remedy.empty()) text.append("; ").append(remedy);
  for (char& c : text)
    if (c == '\n' || c == '\r') c = ' ';
  return text;
}

}  // namespace

Error::Error(Kind kind, std::string_view place, std::string_view problem, std::string_view remedy)
    : std::runtime_error(one_line(place, problem, remedy)), kind_(kind) {}

Error::Error(Kind kind, const std::string& text, bool has_file)
    : std::runtime_error(text), kind_(kind), has_file_(has_file) {}

Error Error::in_file(std::string_view file) const {
  if (has_file_) return *this;
  return Error(kind_, one_line(file, what(), {}), true);
}

Error invalid_input(std::string_view place, std::string_view problem, std::string_view remedy) {
  return Error(Error::Kind::invalid_input, place, problem, remedy);
}

Error io_error(std::string_view place, std::string_view problem, std::string_view remedy) {
  return Error(Error::Kind::io, place, problem, remedy);
}

}  // namespace mien
