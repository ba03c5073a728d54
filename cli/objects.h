#pragma once
/// Influence objects in words, for every command that lists them.

#include <nlohmann/json.hpp>
#include <string>

#include "mien/character/character.h"

namespace mien::cli {

/// An array with one object an influence object: name, kind, what it is made of, what moves it, what it reaches.
nlohmann::json describe_objects(const Character& character);
std::string object_rows(const nlohmann::json& objects);

}  // namespace mien::cli
