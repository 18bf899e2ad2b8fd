#include "config/cell.hpp"

#include <algorithm>

#include "calib_core/kinematics/place_group.hpp"
#include "config/config_error.hpp"

namespace cell {

calib::CollisionScene Cell::collision_scene() const {
  calib::CollisionScene scene{arm.bodies, block.solids};
  scene.bodies.insert(scene.bodies.end(), probe.bodies.begin(), probe.bodies.end());
  scene.obstacles.insert(scene.obstacles.end(), keep_out_boxes.begin(), keep_out_boxes.end());
  return scene;
}

std::optional<double> AcceptanceLimits::tip_box_max_of_m(const std::string& recipe) const {
  const auto own = tip_box_max_by_recipe_m.find(recipe);
  return own == tip_box_max_by_recipe_m.end() ? tip_box_max_m : own->second;
}

double Cell::face_error_m() const {
  // The larger one and no sum: the uncalibrated arm that misses the faces is the one that located them, and
  // the place's covariance has its errors already, wider than they are. Each is taken for a sixth of the
  // nominal miss, and all of them move the tip by 1.4 times that miss (3 sigma). Brought back to the nominal
  // miss, the arm's miss at the touches of a plan, against the place that it found in other postures, is
  // about the place's own 3 sigma: 21 mm and 21 (demo), 25 and 25 (edf).
  return std::max(nominal_position_error_m, place_error_m);
}

Cell with_block_temperature(const Cell& cell, const std::optional<BlockTemperature>& given) {
  Cell there = cell;
  if (!given) return there;
  there.block.temperature_c = given->celsius;
  there.block.std_temperature_k = given->std_k;
  there.block.temperature_at = given->measured_at;
  return there;
}

calib::ArtefactKnowledge artefact_knowledge(const Cell& cell) {
  constexpr double kReferenceCelsius = 20.0;
  const Block& block = cell.block;
  return {.faces = block.faces,
          .face_uncertainties = block.face_uncertainties,
          .lengths = block.lengths,
          .stylus = cell.probe.stylus,
          .std_radius_m = cell.probe.std_stylus_radius_m,
          .std_pretravel_m = cell.probe.std_pretravel_m,
          .std_pretravel_tilt_m = cell.probe.std_pretravel_tilt_m,
          .std_lobes_m = cell.probe.std_lobes_m,
          .warmer_than_20_c_k = block.temperature_c.value_or(kReferenceCelsius) - kReferenceCelsius,
          .std_temperature_k = block.std_temperature_k,
          .thermal_expansion_per_k = block.thermal_expansion_per_k.value_or(0.0)};
}

calib::ErrorTolerances prior_tolerances(const Cell& cell) {
  calib::ErrorTolerances tolerances = cell.arm.std_errors;
  const auto& parameters = calib::error_parameters();
  for (std::size_t i = 0; i < parameters.size(); ++i) {
    if (tolerances[i] ||
        calib::group_on(cell.arm.model, static_cast<int>(i)) != calib::ParameterGroup::kBlockPose)
      continue;
    tolerances[i] =
        parameters[i].is_length() ? cell.unknown_place_std.length_m : cell.unknown_place_std.angle_rad;
  }
  return tolerances;
}

void demand_revolute(const Cell& cell) {
  for (std::size_t joint = 0; joint < calib::kJointCount; ++joint) {
    if (cell.arm.model.joint_types[joint] == calib::JointType::kRevolute) continue;
    throw ConfigError(
        cell.file.string(), "/arm",
        "joint " + std::to_string(joint + 1) + " of " + in_quotes(cell.arm.name) +
            " is prismatic; only arms with six revolute joints are planned, driven or simulated, use " +
            "touches of this one with touchcal identify");
  }
}

}  // namespace cell
