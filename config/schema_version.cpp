#include "config/schema_version.hpp"

#include <string>

#include "config/config_error.hpp"

namespace cell {

SchemaVersion schema_version(const nlohmann::json& document, std::string_view kind,
                             std::span<const std::string_view> schemas) {
  for (std::size_t i = 0; i < schemas.size(); ++i)
    if (has_schema(document, schemas[i])) return {.kind = kind, .number = static_cast<int>(i) + 1};
  return {.kind = kind, .number = static_cast<int>(schemas.size())};
}

std::optional<JsonValue> find_since(int since, const JsonObject& object, std::string_view key,
                                    const SchemaVersion& version) {
  auto value = object.find(key);
  if (value && version.number < since) {
    value->fail("unknown key " + in_quotes(std::string(key)) + " in a " + std::string(version.kind) +
                " of version " + std::to_string(version.number) + R"(; raise "schema" to )" +
                std::to_string(since));
  }
  return value;
}

}  // namespace cell
