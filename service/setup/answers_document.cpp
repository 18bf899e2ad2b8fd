#include <nlohmann/json.hpp>

#include "service/setup/answers.hpp"
#include "service/setup/internal/answer_json.hpp"

namespace cell {
namespace {

Json answered_arm_json(const ArmChoice& arm) {
  Json json = Json::object();
  if (!arm.urdf.empty()) {
    json = {{"urdf", arm.urdf}, {"base_link", arm.base_link}, {"tip_link", arm.tip_link}};
  } else if (!arm.dh.empty()) {
    json["dh"] = arm.dh;
    if (!arm.dh_convention.empty()) json["dh_convention"] = arm.dh_convention;
  } else {
    json["file"] = arm.file;
  }
  if (arm.body_radii_mm) json["body_radii_mm"] = *arm.body_radii_mm;
  return json;
}

Json answered_block_json(const CuboidAnswers& block) {
  Json sides = Json::array();
  for (const TouchedSide& side : block.sides) sides.push_back({{"side", side.side}, {"name", side.name}});
  Json certificate = Json::object(), places = Json::array();
  for (const PlaceAnswers& place : block.places)
    places.push_back({{"name", place.name},
                      {"position_mm", triple_json(place.position_mm)},
                      {"rotation_deg", triple_json(place.rotation_deg)},
                      {"within_mm", place.within_mm}});
  for (const auto& [key, text] : block.certificate) certificate[key] = text;
  return {{"name", block.name},
          {"serial", value_or_null(block.serial)},
          {"size_mm", triple_json(block.size_mm)},
          {"std_mm", block.std_mm},
          {"sides", sides},
          {"ground_plate", block.ground_plate},
          {"plate_mm", triple_json(block.plate_mm)},
          {"temperature_c", number(block.temperature_c)},
          {"std_temperature_k", block.std_temperature_k},
          {"thermal_expansion_per_k", block.expansion_per_k},
          {"certificate", certificate},
          {"places", places}};
}

Json answered_probe_json(const ProbeAnswers& probe) {
  return {{"name", probe.name},
          {"serial", value_or_null(probe.serial)},
          {"ball_radius_mm", probe.ball_radius_mm},
          {"std_ball_radius_mm", probe.std_ball_radius_mm},
          {"pretravel_mm", probe.pretravel_mm},
          {"std_pretravel_mm", probe.std_pretravel_mm},
          {"overtravel_mm", probe.overtravel_mm},
          {"speed_mm_s", probe.speed_mm_s},
          {"length_mm", number(probe.length_mm)},
          {"stem_length_mm", probe.stem_length_mm},
          {"stem_radius_mm", probe.stem_radius_mm},
          {"body_length_mm", probe.body_length_mm},
          {"body_radius_mm", probe.body_radius_mm},
          {"holder_length_mm", probe.holder_length_mm},
          {"holder_radius_mm", probe.holder_radius_mm}};
}

Json answered_box_json(const BoxAnswers& box) {
  return {{"name", box.name}, {"min_mm", triple_json(box.min_mm)}, {"max_mm", triple_json(box.max_mm)}};
}

Json answered_tip_json(const std::optional<ToolTipAnswers>& tip) {
  return tip ? Json{{"radius_mm", tip->radius_mm}, {"std_radius_mm", tip->std_radius_mm}} : Json();
}

Json answered_limits_json(const LimitAnswers& limits) {
  Json by_recipe = Json::object();
  for (const auto& [recipe, limit] : limits.tip_box_max_by_recipe_mm) by_recipe[recipe] = limit;
  return {{"held_out_mean_max_mm", limits.held_out_mean_max_mm},
          {"held_out_rms_max_mm", limits.held_out_rms_max_mm},
          {"condition_number_max", limits.condition_number_max},
          {"tip_box_max_mm", limits.tip_box_max_mm},
          {"tip_box_max_by_recipe_mm", by_recipe},
          {"from_plans", limits.from_plans}};
}

}  // namespace

Json triple_json(const Eigen::Vector3d& values) {
  return {values.x() + 0.0, values.y() + 0.0, values.z() + 0.0};  // no -0
}

std::string setup_document(const SetupAnswers& answers) {
  Json boxes = Json::array(), tools = Json::array();
  for (const BoxAnswers& box : answers.keep_out_boxes) boxes.push_back(answered_box_json(box));
  for (const ToolAnswers& tool : answers.tools)
    tools.push_back({{"name", tool.name},
                     {"position_mm", triple_json(tool.position_mm)},
                     {"rotation_deg", triple_json(tool.rotation_deg)},
                     {"tip", answered_tip_json(tool.tip)}});
  const Json base = answers.base ? Json{{"position_mm", triple_json(answers.base->position_mm)},
                                        {"rotation_deg", triple_json(answers.base->rotation_deg)}}
                                 : Json();
  const Json park = answers.park_joints_deg ? Json(*answers.park_joints_deg) : Json();
  const Json document{{"schema", kSetupSchema},
                      {"name", answers.name},
                      {"arm", answered_arm_json(answers.arm)},
                      {"arm_serial", value_or_null(answers.arm_serial)},
                      {"controller_serial", value_or_null(answers.controller_serial)},
                      {"base", base},
                      {"block", answered_block_json(answers.block)},
                      {"probe", answered_probe_json(answers.probe)},
                      {"workspace_box", answered_box_json(answers.workspace_box)},
                      {"keep_out_boxes", boxes},
                      {"tools", tools},
                      {"nominal_miss_mm", answers.nominal_miss_mm},
                      {"stylus_tilt_max_deg", answers.stylus_tilt_max_deg},
                      {"touch_noise_mm", answers.touch_noise_mm},
                      {"park_joints_deg", park},
                      {"limits", answered_limits_json(answers.limits)},
                      {"default_recipe", answers.default_recipe},
                      {"controller", {{"host", answers.controller.host}, {"port", answers.controller.port}}}};
  return document.dump(2) + "\n";
}

}  // namespace cell
