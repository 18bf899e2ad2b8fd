#include "config/file_bytes.hpp"

#include <array>
#include <fstream>
#include <nlohmann/json.hpp>

#include "config/config_error.hpp"
#include "config/strict_json.hpp"

namespace cell {

std::string read_file_bytes(const std::filesystem::path& file, std::size_t size_max_bytes) {
  std::error_code error;
  const auto status = std::filesystem::status(file, error);
  if (status.type() == std::filesystem::file_type::not_found) {
    throw ConfigError(file.string(), "", "there is no such file; check the path");
  }
  if (std::filesystem::is_directory(status)) {
    throw ConfigError(file.string(), "", "is a folder; name a file in it");
  }
  std::ifstream stream(file, std::ios::binary);
  if (!stream) throw ConfigError(file.string(), "", "cannot be opened; check its permissions");
  std::string bytes;
  std::array<char, 1U << 16U> chunk;
  while (stream && bytes.size() <= size_max_bytes) {
    stream.read(chunk.data(), chunk.size());
    bytes.append(chunk.data(), static_cast<std::size_t>(stream.gcount()));
  }
  if (stream.bad()) throw ConfigError(file.string(), "", "cannot be read; check the disk");
  if (bytes.size() > size_max_bytes) {
    throw ConfigError(file.string(), "",
                      "larger than " + std::to_string(size_max_bytes) + " bytes; make it smaller");
  }
  if (bytes.empty()) throw ConfigError(file.string(), "", "is empty; give a document");
  return bytes;
}

nlohmann::json read_json_file(const std::filesystem::path& file) {
  return parse_strict_json(file.string(), read_file_bytes(file, kConfigFileSizeMax), kConfigFileSizeMax);
}

}  // namespace cell
