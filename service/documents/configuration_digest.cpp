#include "service/documents/configuration_digest.hpp"

#include <nlohmann/json.hpp>

#include "config/file_bytes.hpp"
#include "service/base/digest.hpp"

namespace cell {

std::optional<std::string> configuration_digest(const Cell& cell) {
  if (cell.files.empty()) return std::nullopt;
  std::string canonical;
  for (const std::filesystem::path& file : cell.files) canonical += read_json_file(file).dump() + "\n";
  return sha256_hex(canonical);
}

}  // namespace cell
