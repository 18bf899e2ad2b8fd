#include "service/traceability.hpp"

#include <openssl/evp.h>
#include <spdlog/fmt/fmt.h>

#include <array>
#include <cmath>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "config/block_file.hpp"
#include "config/file_bytes.hpp"
#include "cs8_protocol/messages.hpp"
#include "service/http/json_figures.hpp"
#include "service/version.hpp"

namespace cell {
namespace {

std::string sha256_hex(const std::string& bytes) {
  std::array<unsigned char, EVP_MAX_MD_SIZE> digest{};
  unsigned int size = 0;
  if (EVP_Digest(bytes.data(), bytes.size(), digest.data(), &size, EVP_sha256(), nullptr) != 1)
    throw std::runtime_error("SHA-256 is not to be had from OpenSSL");
  std::string hex;
  for (unsigned int i = 0; i < size; ++i) hex += fmt::format("{:02x}", digest[i]);
  return hex;
}

Json text_or_null(const std::optional<std::string>& text) { return text ? Json(*text) : Json(nullptr); }

Json texts(const std::map<std::string, std::string>& certificate) {
  if (certificate.empty()) return nullptr;
  Json object = Json::object();
  for (const auto& [key, value] : certificate) object[key] = value;
  return object;
}

/// Where the temperature in `conditions` comes from.
Json temperature_source(const Conditions& conditions) {
  if (!conditions.block_temperature_c) return nullptr;
  return conditions.temperature_of_the_run ? "run" : "block_file";
}

}  // namespace

std::optional<std::string> configuration_digest(const Cell& cell) {
  if (cell.files.empty()) return std::nullopt;
  std::string canonical;
  for (const std::filesystem::path& file : cell.files) canonical += read_json_file(file).dump() + "\n";
  return sha256_hex(canonical);
}

std::optional<std::string> temperature_gap(const Cell& cell, std::optional<double> told_with_the_run_c) {
  if (told_with_the_run_c) {
    if (!(*told_with_the_run_c >= kBlockTemperatureMinC && *told_with_the_run_c <= kBlockTemperatureMaxC))
      return fmt::format("a block of {:g} degrees C is none; give a temperature from {:g} to {:g}",
                         *told_with_the_run_c, kBlockTemperatureMinC, kBlockTemperatureMaxC);
    if (cell.block.thermal_expansion_per_k == 0.0 && !cell.block.temperature_c)
      return fmt::format(
          "how the block {} grows with the temperature is unknown; give its file "
          "\"temperature_c\":\"each_run\", "
          "\"std_temperature_k\" and \"thermal_expansion_per_k\"",
          cell.block.name);
    return std::nullopt;
  }
  if (cell.block.temperature_c) return std::nullopt;
  return fmt::format(
      "nobody says how warm the block {} is; measure it and give it with the run (block_temperature_c, or "
      "touchcal run --temperature), or in the block's file (temperature_c)",
      cell.block.name);
}

Cell at_temperature(Cell cell, double block_temperature_c) {
  cell.block.temperature_c = block_temperature_c;
  return cell;
}

Json conditions_json(const Cell& cell, const Conditions& conditions) {
  return {{"operator", text_or_null(conditions.operator_name)},
          {"config_digest", text_or_null(conditions.config_digest)},
          {"block_temperature_c", number(conditions.block_temperature_c)},
          {"block_temperature_source", temperature_source(conditions)},
          {"std_temperature_k",
           conditions.block_temperature_c ? number(cell.block.std_temperature_k) : Json(nullptr)},
          {"thermal_expansion_per_k",
           conditions.block_temperature_c ? number(cell.block.thermal_expansion_per_k) : Json(nullptr)},
          {"block", {{"name", cell.block.name}, {"certificate", texts(cell.block.certificate)}}},
          {"probe", {{"name", cell.probe.name}, {"certificate", texts(cell.probe.certificate)}}},
          {"versions",
           {{"touchcal", kVersion},
            {"protocol", cs8::kProtocolVersion},
            {"controller_application", text_or_null(conditions.controller_application)}}},
          {"controller_session",
           conditions.controller_session ? Json(*conditions.controller_session) : Json(nullptr)}};
}

}  // namespace cell
