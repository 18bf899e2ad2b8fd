#include "service/documents/cell_view.hpp"

#include <nlohmann/json.hpp>

#include "calib_core/geometry/units.hpp"
#include "config/touched_places.hpp"
#include "service/base/utc_time.hpp"
#include "service/documents/internal/geometry_json.hpp"
#include "service/documents/internal/place_view.hpp"
#include "service/documents/scene_view.hpp"
#include "service/run/fault_table.hpp"

namespace cell {
namespace {

using calib::mm_from_metres;

Json bore_json(const calib::Face& face) {
  const calib::BoreWall& bore = *face.bore;
  const double half_m = face.half_extent_m.x();
  return {{"mouth_mm", vector_mm_json(bore.center_m + bore.mouth_m * bore.axis)},
          {"axis", {bore.axis.x(), bore.axis.y(), bore.axis.z()}},
          {"radius_mm", mm_from_metres(surface_of(face).radius_m())},
          {"depth_mm", {mm_from_metres(bore.mouth_m - half_m), mm_from_metres(bore.mouth_m + half_m)}},
          {"wall_half_angle_deg", calib::degrees_from_radians(bore.half_angle_rad)}};
}

Json faces_json(const Block& block) {
  Json faces = Json::array();
  for (const calib::Face& face : block.faces) {
    const Eigen::Vector3d& outward = face.plane.outward;
    faces.push_back({{"plane", faces.size() + 1},
                     {"shape", face.bore ? "bore" : (face.cap ? "sphere" : "plane")},
                     {"outward", {outward.x(), outward.y(), outward.z()}},
                     {"offset_mm", mm_from_metres(face.plane.offset_m)},
                     {"center_mm", vector_mm_json(face.center_m)},
                     {"edge_u", {face.edge_u.x(), face.edge_u.y(), face.edge_u.z()}},
                     {"half_extent_mm",
                      {mm_from_metres(face.half_extent_m.x()), mm_from_metres(face.half_extent_m.y())}}});
    if (face.bore) faces.back()["bore"] = bore_json(face);
    if (!face.cap) continue;
    faces.back()["sphere"] = {{"center_mm", vector_mm_json(face.cap->center_m)},
                              {"radius_mm", mm_from_metres(surface_of(face).radius_m())},
                              {"cap_half_angle_deg", calib::degrees_from_radians(face.cap->half_angle_rad)}};
  }
  return faces;
}

Json limits_json(const AcceptanceLimits& limits) {
  Json by_recipe = Json::object();
  for (const auto& [recipe, limit_m] : limits.tip_box_max_by_recipe_m)
    by_recipe[recipe] = mm_from_metres(limit_m);
  const Json probe = {{"scatter_max_mm", number_mm(limits.probe.scatter_max_m)},
                      {"run_out_max_mm", number_mm(limits.probe.run_out_max_m)},
                      {"lobes_max_mm", number_mm(limits.probe.lobes_max_m)},
                      {"step_max_mm", number_mm(limits.probe.step_max_m)}};
  return {{"held_out_mean_max_mm", mm_from_metres(limits.held_out_mean_max_m)},
          {"held_out_rms_max_mm", mm_from_metres(limits.held_out_rms_max_m)},
          {"condition_number_max", limits.condition_number_max},
          {"lack_of_fit_p_min", limits.lack_of_fit_p_min},
          {"tip_box_rms_max_mm", number_mm(limits.tip_box_rms_max_m)},
          {"tip_box_max_mm", number_mm(limits.tip_box_max_m)},
          {"tip_box_max_by_recipe_mm", by_recipe},
          {"proof_rms_max_mm", number_mm(limits.proof_rms_max_m)},
          {"probe", probe}};
}

/// A figure of which nothing is said, neither itself nor its deviation, is unknown.
Json said_mm(double value_m, double std_m) {
  return value_m == 0.0 && std_m == 0.0 ? Json() : Json(mm_from_metres(value_m));
}

Json probe_tips_json(const Probe& probe) {
  Json tips = Json::array();
  for (const ProbeTip& tip : probe.tips)
    tips.push_back({{"name", tip.name},
                    {"center_mm", vector_mm_json(tip.center_m)},
                    {"radius_mm", mm_from_metres(tip.radius_m)}});
  return tips;
}

Json probe_json(const Probe& probe) {
  const calib::SidewaysPretravel& sideways = probe.stylus.sideways;
  return {{"name", probe.name},
          {"tip_is_contact_point", probe.tip_is_contact_point},
          {"stylus_radius_mm", mm_from_metres(probe.stylus.radius_m)},
          {"pretravel_mm", mm_from_metres(probe.stylus.pretravel_m)},
          {"pretravel_tilt_mm", said_mm(sideways.tilt_m, probe.std_pretravel_tilt_m)},
          {"std_pretravel_tilt_mm", said_mm(probe.std_pretravel_tilt_m, 0.0)},
          {"lobes_mm", said_mm(sideways.lobes_m, probe.std_lobes_m)},
          {"std_lobes_mm", said_mm(probe.std_lobes_m, 0.0)},
          {"lobe_direction_deg",
           sideways.lobes_m == 0.0 ? Json() : Json(calib::degrees_from_radians(sideways.lobe_direction_rad))},
          {"tips", probe_tips_json(probe)}};
}

}  // namespace

std::string recipes_document(const Cell& cell) {
  Json list = Json::array();
  for (const auto& [name, recipe] : cell.recipes) {
    Json planes = Json::array();
    for (const int face : touched_faces(cell.block, recipe)) planes.push_back(face + 1);
    const auto faces = static_cast<int>(planes.size());
    Json places = Json::array();
    for (int place = 1; place < place_count(recipe); ++place)
      places.push_back(place_name(cell.block, recipe, place));
    Json tips = Json::array();
    for (const int tip : recipe.tips) tips.push_back(cell.probe.tips.at(static_cast<std::size_t>(tip)).name);
    list.push_back(
        {{"name", name},
         {"description", recipe.description},
         {"planes", planes},
         {"places", places},
         {"tips", tips},
         {"fit_max", recipe.fit_per_face > 0 ? recipe.fit_per_face * faces : recipe.goal.fit_count},
         {"held_out", recipe.held_out_per_face * (faces / tip_count(recipe))},
         {"tip_rms_max_mm", number_mm(recipe.goal.tip_rms_max_m)}});
  }
  return text_of({{"recipes", list}, {"default", cell.default_recipe}});
}

namespace {

/// A rotation vector in degrees.
Json turn_deg_json(const Eigen::Matrix3d& rotation) {
  const Eigen::AngleAxisd turn(rotation);
  const Eigen::Vector3d vector = turn.angle() * turn.axis() / calib::kRadiansPerDegree;
  return {vector.x(), vector.y(), vector.z()};
}

/// Where else the block can stand: the pose of R_-1 there in R_-1 of the first place.
Json places_json(const Block& block) {
  Json places = Json::array();
  for (const BlockPlace& place : block.places)
    places.push_back({{"name", place.name},
                      {"is_known", place.std.has_value()},
                      {"shift_mm", vector_mm_json(place.first_from_place.translation())},
                      {"turn_deg", turn_deg_json(place.first_from_place.linear())}});
  return places;
}

Json tool_tips_json(const Cell& cell) {
  Json names = Json::array();
  for (const auto& [name, unused] : cell.tool_tips) names.push_back(name);
  return names;
}

}  // namespace

std::string cell_document(const Cell& cell, const std::optional<BlockPose>& place) {
  Json keep_out = Json::array();
  for (const calib::Box& box : cell.keep_out_boxes) keep_out.push_back(box_json(box));
  return text_of(
      {{"name", cell.name},
       {"arm", cell.arm.name},
       {"block",
        {{"name", cell.block.name},
         {"temperature_c", number(cell.block.temperature_c)},
         {"std_temperature_k", cell.block.temperature_c ? Json(cell.block.std_temperature_k) : Json()},
         {"temperature_at",
          cell.block.temperature_at ? Json(format_utc(*cell.block.temperature_at)) : Json()},
         {"faces", faces_json(cell.block)},
         {"places", places_json(cell.block)}}},
       {"place", block_pose_json(place)},
       {"probe", probe_json(cell.probe)},
       {"tool_tips", tool_tips_json(cell)},
       {"default_recipe", cell.default_recipe},
       {"workspace_box", box_json(cell.workspace_box)},
       {"keep_out_boxes", keep_out},
       {"nominal_miss_mm", mm_from_metres(cell.nominal_position_error_m)},
       {"touch_noise_mm", mm_from_metres(cell.touch_noise_m)},
       {"acceptance", limits_json(cell.acceptance)},
       {"scene", scene_json(cell)},
       {"controller", endpoint_text(cell.controller)},
       {"confirm_s", static_cast<double>(cell.deadlines.confirm.count()) / 1000.0}});
}

std::string faults_document() {
  Json list = Json::array();
  for (const FaultEntry& entry : fault_table()) {
    list.push_back({{"code", entry.name},
                    {"kind", fault_kind_name(entry.kind)},
                    {"cause", entry.cause},
                    {"robot_action", entry.robot_action},
                    {"next_step", entry.next_step}});
  }
  return text_of({{"faults", list}});
}

}  // namespace cell
