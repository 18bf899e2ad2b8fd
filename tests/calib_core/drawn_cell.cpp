#include "tests/calib_core/drawn_cell.hpp"

#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <string>

#include "calib_core/identification/face_distances.hpp"
#include "calib_core/kinematics/inverse_kinematics.hpp"
#include "calib_core/numerics/halton.hpp"
#include "calib_core/observability/observation_matrix.hpp"
#include "calib_core/planning/touch_feasibility.hpp"

namespace calib::drawn {

ErrorTolerances tolerances() {
  std::ifstream file(TOUCHCAL_SOURCE_DIR "/config/arms/tx90.json");
  const nlohmann::json arm = nlohmann::json::parse(file);
  ErrorTolerances result;
  for (std::size_t i = 0; i < result.size(); ++i) {
    const ErrorParameter& parameter = error_parameters()[i];
    if (parameter.group() == ParameterGroup::kBlockPose) {
      result[i] = parameter.is_length() ? kPlaceMetres : kPlaceRadians;
    }
  }
  for (const nlohmann::json& frame : arm.at("frames")) {
    if (!frame.contains("std")) continue;
    for (const auto& [key, value] : frame.at("std").items()) {
      const std::size_t unit = key.rfind('_');
      const auto index =
          error_parameter_index(key.substr(0, unit) + std::to_string(frame.at("j").get<int>()));
      const bool is_length = key.substr(unit) == "_mm";
      result[static_cast<std::size_t>(index.value())] = value.get<double>() * (is_length ? 1e-3 : 1.0);
    }
  }
  return result;
}

ArtefactKnowledge certain_artefact(std::size_t face_count) {
  ArtefactKnowledge knowledge;
  knowledge.faces = tx90::faces();
  knowledge.faces.resize(face_count);
  knowledge.face_uncertainties.resize(face_count);
  knowledge.stylus = {.radius_m = 0.003, .pretravel_m = 10e-6};
  return knowledge;
}

ArtefactKnowledge uncertain_artefact(std::size_t face_count) {
  ArtefactKnowledge knowledge = certain_artefact(face_count);
  for (FaceUncertainty& face : knowledge.face_uncertainties) face = {5e-6, 5.8e-5, false};
  knowledge.std_radius_m = 5e-6;
  knowledge.std_pretravel_m = 2e-6;
  knowledge.thermal_expansion_per_k = 2.36e-5;
  knowledge.std_temperature_k = 1.0;
  return knowledge;
}

Face ball(double cap_half_angle_deg) {
  return sphere_face({0.14, -0.18, 0.11}, 0.025, {0, -1, 0}, radians_from_degrees(cap_half_angle_deg));
}

Face bore(double wall_half_angle_deg) {
  return bore_face({.center_m = {0.14, -0.038, 0.11},
                    .axis = {0, -1, 0},
                    .mouth_m = 0.022,
                    .half_angle_rad = radians_from_degrees(wall_half_angle_deg)},
                   0.042, {1, 0, 0}, 0.020);
}

Box bored_ring() {
  Box ring{"ring", {0.09, -0.06, 0.06}, {0.19, 0.0, 0.16}};
  ring.holes.push_back({{0.14, -0.038, 0.11}, {0, -1, 0}, 0.042});
  return ring;
}

IdentificationProblem problem(const ArtefactKnowledge& knowledge, double touch_noise_m) {
  IdentificationProblem problem;
  problem.nominal = paper::nominal();
  problem.artefact = make_artefact(knowledge);
  problem.touch_noise_m = touch_noise_m;
  problem.tolerances = tolerances();
  return problem;
}

Truth truth_of(const IdentificationProblem& cell, const ErrorVector& errors,
               const Eigen::VectorXd& artefact_errors) {
  Truth truth{errors, artefact_errors, apply(cell.nominal, errors), {}};
  correct_contact_planes(cell.artefact, artefact_errors, truth.planes);
  return truth;
}

ErrorVector errors_on(const std::vector<int>& columns, UniformChance& chance) {
  const ErrorTolerances known = tolerances();
  ErrorVector errors = ErrorVector::Zero();
  for (const int column : columns) {
    const double std = std::min(known[static_cast<std::size_t>(column)].value(), 2e-3);
    errors[column] = std * study::normal(chance);
  }
  return errors;
}

Eigen::VectorXd draw_artefact_errors(const Artefact& artefact, UniformChance& chance) {
  Eigen::VectorXd errors(static_cast<Eigen::Index>(artefact.parameters.size()));
  for (std::size_t k = 0; k < artefact.parameters.size(); ++k) {
    const ArtefactParameter& parameter = artefact.parameters[k];
    const double free = parameter.kind == ArtefactKind::kFaceOffset ? 0.5e-3 : 1e-3;
    errors[static_cast<Eigen::Index>(k)] = parameter.std.value_or(free) * study::normal(chance);
  }
  return errors;
}

Truth draw_truth(const IdentificationProblem& cell, UniformChance& chance) {
  ErrorVector errors = ErrorVector::Zero();
  for (int i = 0; i < kErrorParameterCount; ++i) {
    errors[i] = cell.tolerances[static_cast<std::size_t>(i)].value_or(0.0) * study::normal(chance);
  }
  return truth_of(cell, errors, draw_artefact_errors(cell.artefact, chance));
}

std::vector<Touch> touches(const Truth& truth, const Manner& manner, UniformChance& chance) {
  const std::vector<Face> all = manner.block.empty() ? tx90::faces() : manner.block;
  const PlanningProblem cell{.nominal_position_error_m = 0.012, .tilt_max_rad = manner.tilt_max_rad};
  std::vector<Touch> made;
  while (std::ssize(made) < manner.count) {
    const std::size_t turn = made.size() % (manner.faces.empty() ? truth.planes.size() : manner.faces.size());
    const auto face = manner.faces.empty() ? turn : static_cast<std::size_t>(manner.faces[turn]);
    const TouchPose pose = sample_touch_pose(cell, all[face], chance);
    const auto postures = inverse_kinematics(paper::nominal(), tx90::joint_ranges(), pose.block_from_tip);
    if (postures.empty()) continue;
    const auto pick = static_cast<std::size_t>(chance() * static_cast<double>(postures.size()));
    ContactSurface met = truth.planes[face];
    met.offset_m += manner.noise_m * study::normal(chance);
    made.push_back(
        moved_onto_plane(truth.arm, met, {.face = static_cast<int>(face), .joints = postures[pick]}));
  }
  return made;
}

double nominal_position_error_m(const IdentificationProblem& cell, const std::vector<Touch>& touches) {
  return signed_distances_m(cell.nominal, cell.artefact.contact_planes, touches).cwiseAbs().maxCoeff();
}

double tip_mean_square_over_ranges(const KinematicModel& one, const KinematicModel& other) {
  constexpr int kPostures = 200;
  double sum = 0.0;
  for (int i = 1; i <= kPostures; ++i) {
    const JointVector joints = halton_posture(i, tx90::joint_ranges());
    sum += (forward_kinematics(one, joints).translation() - forward_kinematics(other, joints).translation())
               .squaredNorm();
  }
  return sum / kPostures;
}

double tip_mean_square_over_touches(const KinematicModel& one, const KinematicModel& other,
                                    const std::vector<Touch>& touches) {
  double sum = 0.0;
  for (const Touch& touch : touches) {
    sum += (forward_kinematics(one, touch.joints).translation() -
            forward_kinematics(other, touch.joints).translation())
               .squaredNorm();
  }
  return sum / static_cast<double>(touches.size());
}

}  // namespace calib::drawn
