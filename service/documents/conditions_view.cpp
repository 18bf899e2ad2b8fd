#include "service/documents/conditions_view.hpp"

#include <nlohmann/json.hpp>

#include "cs8_protocol/messages.hpp"
#include "service/base/json_figures.hpp"
#include "service/base/version.hpp"
#include "service/documents/internal/place_view.hpp"

namespace cell {
namespace {

Json texts(const std::map<std::string, std::string>& certificate) {
  if (certificate.empty()) return nullptr;
  Json object = Json::object();
  for (const auto& [key, value] : certificate) object[key] = value;
  return object;
}

}  // namespace

Json conditions_json(const Cell& cell, const RunConditions& conditions) {
  return {
      {"operator", value_or_null(conditions.operator_name)},
      {"config_digest", value_or_null(conditions.config_digest)},
      {"block_temperature_c", number(cell.block.temperature_c)},
      {"std_temperature_k", cell.block.temperature_c ? number(cell.block.std_temperature_k) : Json(nullptr)},
      {"thermal_expansion_per_k",
       cell.block.temperature_c ? number(cell.block.thermal_expansion_per_k) : Json(nullptr)},
      {"block", {{"name", cell.block.name}, {"certificate", texts(cell.block.certificate)}}},
      {"probe", {{"name", cell.probe.name}, {"certificate", texts(cell.probe.certificate)}}},
      {"versions",
       {{"touchcal", kVersion},
        {"protocol", cs8::kProtocolVersion},
        {"controller_application", value_or_null(conditions.controller_application)}}},
      {"controller_session", value_or_null(conditions.controller_session)},
      {"touching", conditions.touch_mode ? Json(touch_mode_name(*conditions.touch_mode)) : Json(nullptr)},
      {"place", block_pose_json(conditions.place)}};
}

std::string conditions_document(const Cell& cell, const RunConditions& conditions) {
  return text_of(conditions_json(cell, conditions));
}

bool is_guided(const std::optional<std::string>& conditions) {
  if (!conditions) return false;
  const Json found = Json::parse(*conditions, nullptr, false);
  return found.is_object() && found.value("touching", Json()) == touch_mode_name(TouchMode::kGuided);
}

}  // namespace cell
