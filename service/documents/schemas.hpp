#pragma once

#include <span>
#include <string_view>

namespace cell {

/// A JSON Schema (2020-12) of a document of the API, by its name in OpenAPI's components.
struct DocumentSchema {
  std::string_view name;
  std::string_view text;  // JSON
};

/// Documents of this daemon alone, and those whose schema is a version of its own: touchcal/result/1 and
/// such; of those, what is of proofs, checks and comparisons.
std::span<const DocumentSchema> daemon_schemas();
std::span<const DocumentSchema> file_schemas();
std::span<const DocumentSchema> verification_schemas();
std::span<const DocumentSchema> people_schemas();  // who signs in
std::span<const DocumentSchema> setup_schemas();   // what a new cell would be
std::span<const DocumentSchema> fleet_schemas();   // the other cells of the plant

}  // namespace cell
