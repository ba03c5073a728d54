#pragma once
/// JSON whose members are checked as they are read, so that every complaint names its place.

#include <cstdint>
#include <initializer_list>
#include <limits>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <vector>

namespace mien::detail {

using Json = nlohmann::json;

/// Parses UTF-8 text of at most 64 nested levels.
///   throws  io at `place`: not JSON, nested deeper, a number that no double holds
Json parse_json(std::string_view text, std::string_view place);

/// One line a number array, two-space levels: for files that people read too.
std::string json_text(const Json& json, int indent = -1);

/// A JSON object together with where it is in the file. Reading a member of the wrong type or out of range
/// throws `io` with that place.
class JsonObject {
 public:
  ///   throws  io: `json` is not an object
  JsonObject(const Json& json, std::string place);

  const std::string& place() const { return place_; }
  const Json& json() const { return *json_; }
  bool has(const char* key) const { return json_->contains(key); }
  std::string place_of(std::string_view key) const;

  std::int64_t integer(const char* key, std::int64_t low, std::int64_t high) const;
  std::int64_t integer_or(const char* key, std::int64_t fallback, std::int64_t low, std::int64_t high) const;
  /// An index in [0, count), or -1 when the member is absent.
  int index_or_none(const char* key, std::size_t count) const;
  int index(const char* key, std::size_t count) const;
  double number(const char* key) const;
  double number_or(const char* key, double fallback) const;
  bool truth_or(const char* key, bool fallback) const;
  std::string text(const char* key) const;
  std::string text_or(const char* key, std::string_view fallback) const;
  JsonObject object(const char* key) const;
  /// The array's elements, each an object; none when the member is absent.
  std::vector<JsonObject> objects(const char* key) const;
  /// The array's numbers, finite; `count` of them unless it is 0; none when the member is absent.
  std::vector<double> numbers(const char* key, std::size_t count = 0) const;
  /// The array's indices, each in [0, count); none when the member is absent.
  std::vector<int> indices(const char* key, std::size_t count) const;
  std::vector<std::string> texts(const char* key) const;

  /// The text of all members but these; empty when there are none.
  std::string others(std::initializer_list<const char*> keys) const;
  ///   throws  io: a member that is not among `keys`
  void expect_only(std::initializer_list<const char*> keys) const;

 private:
  const Json& member(const char* key) const;
  const Json* array(const char* key) const;
  const Json* json_;
  std::string place_;
};

}  // namespace mien::detail
