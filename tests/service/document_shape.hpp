#pragma once

#include <map>
#include <nlohmann/json.hpp>
#include <string>

namespace cell {

/// Field names and JSON types of an object: "string", "boolean", "array", "object", "null"; "number" is
/// finite.
using Shape = std::map<std::string, std::string>;

inline Shape shape_of(const nlohmann::json& object) {
  Shape shape;
  for (const auto& [key, value] : object.items()) shape[key] = value.type_name();
  return shape;
}

}  // namespace cell
