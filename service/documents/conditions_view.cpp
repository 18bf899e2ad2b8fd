#include "service/documents/conditions_view.hpp"

#include <nlohmann/json.hpp>

#include "cs8_protocol/messages.hpp"
#include "service/base/json_figures.hpp"
#include "service/base/version.hpp"
#include "service/documents/place_view.hpp"

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
