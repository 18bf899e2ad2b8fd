#include "service/traceability.hpp"

#include <spdlog/fmt/fmt.h>

#include <nlohmann/json.hpp>

#include "config/block_file.hpp"
#include "config/file_bytes.hpp"
#include "cs8_protocol/messages.hpp"
#include "service/digest.hpp"
#include "service/http/json_figures.hpp"
#include "service/http/place_view.hpp"
#include "service/version.hpp"

namespace cell {
namespace {

Json text_or_null(const std::optional<std::string>& text) { return text ? Json(*text) : Json(nullptr); }

Json texts(const std::map<std::string, std::string>& certificate) {
  if (certificate.empty()) return nullptr;
  Json object = Json::object();
  for (const auto& [key, value] : certificate) object[key] = value;
  return object;
}

Json touching_name(std::optional<Touching> touching) {
  if (!touching) return nullptr;
  return *touching == Touching::kGuided ? "guided" : "automatic";
}

}  // namespace

std::optional<std::string> configuration_digest(const Cell& cell) {
  if (cell.files.empty()) return std::nullopt;
  std::string canonical;
  for (const std::filesystem::path& file : cell.files) canonical += read_json_file(file).dump() + "\n";
  return sha256_hex(canonical);
}

std::optional<std::string> temperature_gap(const Cell& cell) {
  if (cell.block.temperature_c) return std::nullopt;
  return fmt::format(
      "nobody says how warm the block {} is; measure it and give it in the block's file (temperature_c)",
      cell.block.name);
}

Json conditions_json(const Cell& cell, const Conditions& conditions) {
  return {
      {"operator", text_or_null(conditions.operator_name)},
      {"config_digest", text_or_null(conditions.config_digest)},
      {"block_temperature_c", number(cell.block.temperature_c)},
      {"std_temperature_k", cell.block.temperature_c ? number(cell.block.std_temperature_k) : Json(nullptr)},
      {"thermal_expansion_per_k",
       cell.block.temperature_c ? number(cell.block.thermal_expansion_per_k) : Json(nullptr)},
      {"block", {{"name", cell.block.name}, {"certificate", texts(cell.block.certificate)}}},
      {"probe", {{"name", cell.probe.name}, {"certificate", texts(cell.probe.certificate)}}},
      {"versions",
       {{"touchcal", kVersion},
        {"protocol", cs8::kProtocolVersion},
        {"controller_application", text_or_null(conditions.controller_application)}}},
      {"controller_session",
       conditions.controller_session ? Json(*conditions.controller_session) : Json(nullptr)},
      {"touching", touching_name(conditions.touching)},
      {"place", place_view(conditions.place)}};
}

std::string conditions_document(const Cell& cell, const Conditions& conditions) {
  return text_of(conditions_json(cell, conditions));
}

bool is_guided(const std::optional<std::string>& conditions) {
  if (!conditions) return false;
  const Json found = Json::parse(*conditions, nullptr, false);
  return found.is_object() && found.value("touching", Json()) == "guided";
}

}  // namespace cell
