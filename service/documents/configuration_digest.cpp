#include "service/documents/configuration_digest.hpp"

#include <nlohmann/json.hpp>

#include "config/file_bytes.hpp"
#include "config/read_config.hpp"
#include "service/base/digest.hpp"

namespace cell {

std::optional<std::string> configuration_digest(const Cell& cell) {
  if (cell.files.empty()) return std::nullopt;
  std::string canonical;
  for (const std::filesystem::path& file : cell.files) {
    auto document = read_json_file(file);
    // How often the cell is to be checked says nothing of the cell: a rule that is changed must not end the
    // checks of the calibration that it is for.
    // Nor do the frames of its targets, which are touched anew as pallets come and go.
    if (document.is_object()) {
      for (const char* key : {"check_every_days", "target_frames"}) document.erase(key);
      // Version 7 has the frames beside what version 6 has: a cell that gets its first pallet is the same
      // cell.
      if (document.value("schema", nlohmann::json()) == kCellSchema) document["schema"] = kSixthCellSchema;
    }
    canonical += document.dump() + "\n";
  }
  return sha256_hex(canonical);
}

}  // namespace cell
