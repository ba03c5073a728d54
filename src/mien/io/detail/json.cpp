#include "mien/io/detail/json.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "mien/core/error.h"

namespace mien::detail {
namespace {

/// nlohmann parses any depth, but printing and copying recurse.
void check_depth(std::string_view text, std::string_view place) {
  constexpr int limit = 64;
  int depth = 0;
  bool in_string = false;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    if (in_string) {
      if (c == '\\')
        ++i;
      else if (c == '"')
        in_string = false;
    } else if (c == '"') {
      in_string = true;
    } else if (c == '[' || c == '{') {
      if (++depth > limit)
        throw io_error(place, fmt::format("JSON is nested deeper than {} levels", limit),
                       "use a flatter file");
    } else if (c == ']' || c == '}') {
      --depth;
    }
  }
}

Error wrong_type(const std::string& place, std::string_view wanted, const Json& got) {
  return io_error(place,
                  fmt::format("is {} {}", got.is_array() || got.is_object() ? "an" : "a", got.type_name()),
                  fmt::format("give {}", wanted));
}

std::int64_t checked_integer(const Json& value, const std::string& place, std::int64_t low,
                             std::int64_t high) {
  const bool whole = value.is_number_integer() ||
                     (value.is_number_float() && std::floor(value.get<double>()) == value.get<double>() &&
                      std::abs(value.get<double>()) < 9e15);
  if (!whole) {
    if (value.is_number()) throw io_error(place, "is " + value.dump(), "give a whole number");
    throw wrong_type(place, "a whole number", value);
  }
  const bool beyond =
      value.is_number_unsigned() &&
      value.get<std::uint64_t>() > static_cast<std::uint64_t>(std::numeric_limits<std::int64_t>::max());
  const std::int64_t number = beyond ? std::numeric_limits<std::int64_t>::max() : value.get<std::int64_t>();
  if (number < low || number > high) {
    const std::string remedy = high < low                 ? "there is nothing to name"
                               : high > 4'000'000'000'000 ? fmt::format("give at least {}", low)
                                                          : fmt::format("give {} to {}", low, high);
    throw io_error(place, "is " + value.dump(), remedy);
  }
  return number;
}

double checked_number(const Json& value, const std::string& place) {
  if (!value.is_number()) throw wrong_type(place, "a number", value);
  const double number = value.get<double>();
  if (!std::isfinite(number)) throw io_error(place, "is not finite", "give a finite number");
  return number;
}

}  // namespace

Json parse_json(std::string_view text, std::string_view place) {
  check_depth(text, place);
  try {
    return Json::parse(text.begin(), text.end());
  } catch (const Json::parse_error& error) {
    throw io_error(place, fmt::format("is not valid JSON at byte {}", error.byte),
                   "give well-formed UTF-8 JSON");
  } catch (const Json::exception&) {
    throw io_error(place, "holds a number that is out of range", "give numbers that a double can hold");
  }
}

std::string json_text(const Json& json, int indent) {
  return json.dump(indent, ' ', false, Json::error_handler_t::replace);
}

JsonObject::JsonObject(const Json& json, std::string place) : json_(&json), place_(std::move(place)) {
  if (!json.is_object()) throw wrong_type(place_.empty() ? "file" : place_, "an object", json);
}

std::string JsonObject::place_of(std::string_view key) const {
  return place_.empty() ? std::string(key) : fmt::format("{}.{}", place_, key);
}

const Json& JsonObject::member(const char* key) const {
  const auto found = json_->find(key);
  if (found == json_->end())
    throw io_error(place_.empty() ? "file" : place_, fmt::format("has no \"{}\"", key));
  return *found;
}

const Json* JsonObject::array(const char* key) const {
  const auto found = json_->find(key);
  if (found == json_->end()) return nullptr;
  if (!found->is_array()) throw wrong_type(place_of(key), "an array", *found);
  return &*found;
}

std::int64_t JsonObject::integer(const char* key, std::int64_t low, std::int64_t high) const {
  return checked_integer(member(key), place_of(key), low, high);
}

std::int64_t JsonObject::integer_or(const char* key, std::int64_t fallback, std::int64_t low,
                                    std::int64_t high) const {
  return has(key) ? integer(key, low, high) : fallback;
}

int JsonObject::index(const char* key, std::size_t count) const {
  return static_cast<int>(integer(key, 0, static_cast<std::int64_t>(count) - 1));
}

int JsonObject::index_or_none(const char* key, std::size_t count) const {
  return has(key) ? index(key, count) : -1;
}

double JsonObject::number(const char* key) const {
  return checked_number(member(key), place_of(key));
}

double JsonObject::number_or(const char* key, double fallback) const {
  return has(key) ? number(key) : fallback;
}

bool JsonObject::truth_or(const char* key, bool fallback) const {
  if (!has(key)) return fallback;
  if (!member(key).is_boolean()) throw wrong_type(place_of(key), "true or false", member(key));
  return member(key).get<bool>();
}

std::string JsonObject::text(const char* key) const {
  if (!member(key).is_string()) throw wrong_type(place_of(key), "a string", member(key));
  return member(key).get<std::string>();
}

std::string JsonObject::text_or(const char* key, std::string_view fallback) const {
  return has(key) ? text(key) : std::string(fallback);
}

JsonObject JsonObject::object(const char* key) const {
  return JsonObject(member(key), place_of(key));
}

std::vector<JsonObject> JsonObject::objects(const char* key) const {
  std::vector<JsonObject> result;
  const Json* elements = array(key);
  if (!elements) return result;
  result.reserve(elements->size());
  for (const Json& element : *elements)
    result.emplace_back(element, fmt::format("{}[{}]", place_of(key), result.size()));
  return result;
}

std::vector<double> JsonObject::numbers(const char* key, std::size_t count) const {
  std::vector<double> result;
  const Json* elements = array(key);
  if (!elements) return result;
  if (count > 0 && elements->size() != count)
    throw io_error(place_of(key), fmt::format("has {} numbers", elements->size()),
                   fmt::format("give {}", count));
  result.reserve(elements->size());
  for (const Json& element : *elements)
    result.push_back(checked_number(element, fmt::format("{}[{}]", place_of(key), result.size())));
  return result;
}

std::vector<int> JsonObject::indices(const char* key, std::size_t count) const {
  std::vector<int> result;
  const Json* elements = array(key);
  if (!elements) return result;
  result.reserve(elements->size());
  for (const Json& element : *elements)
    result.push_back(
        static_cast<int>(checked_integer(element, fmt::format("{}[{}]", place_of(key), result.size()), 0,
                                         static_cast<std::int64_t>(count) - 1)));
  return result;
}

std::vector<std::string> JsonObject::texts(const char* key) const {
  std::vector<std::string> result;
  const Json* elements = array(key);
  if (!elements) return result;
  for (const Json& element : *elements) {
    if (!element.is_string())
      throw wrong_type(fmt::format("{}[{}]", place_of(key), result.size()), "a string", element);
    result.push_back(element.get<std::string>());
  }
  return result;
}

std::string JsonObject::others(std::initializer_list<const char*> keys) const {
  Json rest = Json::object();
  for (const auto& [key, value] : json_->items())
    if (std::none_of(keys.begin(), keys.end(), [&](const char* known) { return key == known; }))
      rest[key] = value;
  return rest.empty() ? std::string() : json_text(rest);
}

void JsonObject::expect_only(std::initializer_list<const char*> keys) const {
  for (const auto& [key, value] : json_->items())
    if (std::none_of(keys.begin(), keys.end(), [&](const char* known) { return key == known; }))
      throw io_error(place_.empty() ? "file" : place_, fmt::format("has an unknown member \"{}\"", key),
                     fmt::format("it may have {}", fmt::join(keys, ", ")));
}

}  // namespace mien::detail
