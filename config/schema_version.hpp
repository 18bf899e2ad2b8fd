#pragma once

#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <span>
#include <string_view>

#include "config/json_value.hpp"

namespace cell {

/// Which of the schemas of its kind a document has: "a probe of version 2".
struct SchemaVersion {
  std::string_view kind;
  int number = 1;
};

/// `schemas`: all of this kind, the first one first. The newest for a document that has none of them, so that
/// the refusal names that one.
SchemaVersion schema_version(const nlohmann::json& document, std::string_view kind,
                             std::span<const std::string_view> schemas);

/// A key that came with a later schema than the first. ConfigError where an earlier document has it.
std::optional<JsonValue> find_since(int since, const JsonObject& object, std::string_view key,
                                    const SchemaVersion& version);

}  // namespace cell
