#include "service/documents/configuration_digest.hpp"

#include <nlohmann/json.hpp>

#include "config/file_bytes.hpp"
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
    if (document.is_object())
      for (const char* key : {"check_every_days", "target_frames"}) document.erase(key);
    canonical += document.dump() + "\n";
  }
  return sha256_hex(canonical);
}

}  // namespace cell
