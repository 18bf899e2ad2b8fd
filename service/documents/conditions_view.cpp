#include "service/documents/conditions_view.hpp"

#include <nlohmann/json.hpp>

#include "calib_core/geometry/units.hpp"
#include "cs8_protocol/messages.hpp"
#include "service/base/utc_time.hpp"
#include "service/base/version.hpp"
#include "service/documents/figures.hpp"
#include "service/documents/internal/place_view.hpp"

namespace cell {
namespace {

std::optional<std::map<std::string, std::string>> told(
    const std::map<std::string, std::string>& certificate) {
  return certificate.empty() ? std::nullopt : std::optional(certificate);
}

}  // namespace

ConditionsDocument conditions_of(const Cell& cell, const RunConditions& conditions) {
  ConditionsDocument document{
      .operator_name = conditions.operator_name,
      .config_digest = conditions.config_digest,
      .block_temperature_c = finite(cell.block.temperature_c),
      .arm_moving_min = conditions.arm_moving_min,
      .arm_serial = cell.arm_serial,
      .controller_serial = cell.controller_serial,
      .block = {cell.block.name, cell.block.serial, told(cell.block.certificate)},
      .probe = {cell.probe.name, cell.probe.serial, told(cell.probe.certificate)},
      .versions = {kVersion, cs8::kProtocolVersion, conditions.controller_application},
      .place = block_pose_of(conditions.place)};
  if (conditions.touch_mode) document.touch_mode = touch_mode_name(*conditions.touch_mode);
  if (cell.block.temperature_c) {
    document.std_temperature_k = finite(cell.block.std_temperature_k);
    document.thermal_expansion_per_k = finite(cell.block.thermal_expansion_per_k);
    document.block_temperature_source = temperature_source_name(conditions.temperature_source);
    if (cell.block.temperature_at) document.block_temperature_at = format_utc(*cell.block.temperature_at);
  }
  document.qualification.emplace();
  if (const auto& qualified = conditions.qualified)
    document.qualification->emplace(std::to_string(qualified->run), scatter_um_of(qualified->noise),
                                    qualified->noise.degrees_of_freedom);
  document.tool.emplace(conditions.tool);
  if (conditions.controller_session) document.controller_session = *conditions.controller_session;
  return document;
}

std::string conditions_document(const Cell& cell, const RunConditions& conditions) {
  return document_text(conditions_of(cell, conditions));
}

bool is_guided(const std::optional<std::string>& conditions) {
  if (!conditions) return false;
  return touching_of(*conditions) == touch_mode_name(TouchMode::kGuided);
}

bool names_place(const std::optional<std::string>& conditions) {
  if (!conditions) return false;
  const nlohmann::json document = nlohmann::json::parse(*conditions, nullptr, false);
  const auto place = document.is_object() ? document.find("place") : document.end();
  return place != document.end() && !place->is_null();
}

Eigen::Isometry3d block_stood_at(const std::optional<std::string>& conditions) {
  if (!names_place(conditions)) return Eigen::Isometry3d::Identity();
  const auto place = read_conditions(*conditions).place.value().value();
  const Eigen::Vector3d shift_mm = Eigen::Vector3d::Map(place.shift_mm.data());
  const Eigen::Vector3d turn_deg = Eigen::Vector3d::Map(place.turn_deg.data());
  const double angle_deg = turn_deg.norm();
  const Eigen::Vector3d axis =
      angle_deg > 0.0 ? Eigen::Vector3d(turn_deg / angle_deg) : Eigen::Vector3d::UnitX();
  return Eigen::Translation3d(shift_mm * calib::kMetresPerMillimetre) *
         Eigen::AngleAxisd(angle_deg * calib::kRadiansPerDegree, axis);
}

std::optional<calib::TouchNoise> qualified_noise(const std::optional<std::string>& conditions) {
  if (!conditions || conditions->empty()) return std::nullopt;
  const auto told = read_conditions(*conditions).qualification;
  if (!told || !*told) return std::nullopt;
  return calib::TouchNoise{calib::metres_from_um((*told)->scatter_um), (*told)->degrees_of_freedom};
}

std::optional<std::string> touching_tool(const std::optional<std::string>& conditions) {
  if (!conditions || conditions->empty()) return std::nullopt;
  return read_conditions(*conditions).tool.value_or(std::nullopt);
}

bool stood_at(const std::optional<std::string>& conditions, const std::optional<BlockPose>& place) {
  const auto place_in = [](const std::string& text) {
    const nlohmann::json document = nlohmann::json::parse(text, nullptr, false);
    return document.is_object() ? document.value("place", nlohmann::json()) : nlohmann::json();
  };
  return place_in(conditions.value_or("")) == place_in(document_text({.place = block_pose_of(place)}));
}

}  // namespace cell
