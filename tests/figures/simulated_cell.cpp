#include "tests/figures/simulated_cell.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "calib_core/numerics/uniform_chance.hpp"
#include "calib_core/planning/touch_feasibility.hpp"
#include "calib_core/planning/touch_planning.hpp"

namespace calib::figures {

double median(std::vector<double> values) {
  std::ranges::sort(values);
  return 0.5 * (values[(values.size() - 1) / 2] + values[values.size() / 2]);
}

double quantile(std::vector<double> values, double share) {
  std::ranges::sort(values);
  return values.at(static_cast<std::size_t>(share * static_cast<double>(values.size() - 1)));
}

double root_mean_square(std::span<const double> values) {
  double sum = 0.0;
  for (const double value : values) sum += value * value;
  return std::sqrt(sum / static_cast<double>(values.size()));
}

cell::Cell shipped_cell(const std::string& name) {
  return cell::read_cell(std::string(TOUCHCAL_SOURCE_DIR) + "/config/cells/" + name + "/cell.json");
}

cell::Cell rigid_cell(const std::string& name) {
  cell::Cell cell = shipped_cell(name);
  cell.arm.nongeometric_std = {};
  cell.arm.gears = {};
  for (auto& [recipe_name, recipe] : cell.recipes) {
    recipe.identification.stiffness = false;
    recipe.identification.harmonics = Harmonics::kLeaveOut;
  }
  return cell;
}

ErrorVector draw_errors(const ErrorTolerances& tolerances, UniformChance& chance) {
  ErrorVector errors;
  for (int i = 0; i < kErrorParameterCount; ++i) {
    errors[i] = tolerances[static_cast<std::size_t>(i)].value_or(0.0) * study::normal(chance);
  }
  return errors;
}

std::vector<double> draw_offset_errors_m(const ArtefactKnowledge& known, UniformChance& chance) {
  const Artefact artefact = make_artefact(known);
  const Eigen::MatrixXd covariance = prior_covariance(artefact);
  std::vector<Eigen::Index> places;
  std::vector<std::size_t> faces;
  for (std::size_t k = 0; k < artefact.parameters.size(); ++k) {
    const ArtefactParameter& parameter = artefact.parameters[k];
    if (parameter.kind != ArtefactKind::kFaceOffset || !parameter.std) continue;
    places.push_back(static_cast<Eigen::Index>(k));
    const auto is_moved = [](const ArtefactParameter::Shift& shift) { return shift.constant != 0.0; };
    faces.push_back(static_cast<std::size_t>(std::ranges::find_if(parameter.shifts, is_moved) -
                                             parameter.shifts.begin()));
  }
  std::vector<double> errors_m(known.faces.size(), 0.0);
  if (places.empty()) return errors_m;
  Eigen::VectorXd unit(std::ssize(places));
  for (double& deviate : unit) deviate = study::normal(chance);
  const Eigen::MatrixXd of_offsets = covariance(places, places);
  const Eigen::VectorXd drawn = of_offsets.llt().matrixL() * unit;
  for (std::size_t i = 0; i < faces.size(); ++i) errors_m[faces[i]] = drawn[static_cast<Eigen::Index>(i)];
  return errors_m;
}

DrawnArtefact draw_artefact(const ArtefactKnowledge& known, UniformChance& chance) {
  DrawnArtefact drawn{known, known};
  for (std::size_t i = 0; i < known.face_uncertainties.size(); ++i) {
    drawn.truth.faces[i].plane.offset_m += known.face_uncertainties[i].std_offset_m * study::normal(chance);
  }
  for (KnownLength& length : drawn.known.lengths) {
    const Plane& a = drawn.truth.faces[static_cast<std::size_t>(length.faces[0])].plane;
    const Plane& b = drawn.truth.faces[static_cast<std::size_t>(length.faces[1])].plane;
    const double sign = a.outward.dot(b.outward) > 0.0 ? -1.0 : 1.0;
    length.value_m = std::abs(a.offset_m + sign * b.offset_m) + length.std_m * study::normal(chance);
  }
  for (std::size_t i = 0; i < known.face_uncertainties.size(); ++i) {
    Face& face = drawn.truth.faces[i];
    const double std_rad = known.face_uncertainties[i].std_tilt_rad;
    const Eigen::AngleAxisd about_u(std_rad * study::normal(chance), face.edge_u);
    const Eigen::AngleAxisd about_v(std_rad * study::normal(chance), face.edge_v());
    const Eigen::Vector3d middle_m =
        face.center_m - signed_distance_m(face.plane, face.center_m) * face.plane.outward;
    face.plane.outward = about_u * (about_v * face.plane.outward);
    face.plane.offset_m = face.plane.outward.dot(middle_m);
  }
  drawn.truth.stylus.radius_m += known.std_radius_m * study::normal(chance);
  drawn.truth.stylus.pretravel_m += known.std_pretravel_m * study::normal(chance);
  drawn.truth.warmer_than_20_c_k += known.std_temperature_k * study::normal(chance);
  return drawn;
}

std::vector<Touch> even_touches(const cell::Cell& cell, int face_count, int per_face, UniformChance& chance) {
  const PlanningProblem limits{.nominal_position_error_m = cell.nominal_position_error_m,
                               .tilt_max_rad = cell.stylus_tilt_max_rad};
  std::vector<Touch> touches;
  for (int k = 0; k < per_face; ++k) {
    for (int face = 0; face < face_count; ++face) {
      std::vector<JointVector> postures;
      for (int attempt = 0; postures.empty(); ++attempt) {
        if (attempt == 1000) throw std::logic_error("the face is out of the arm's reach");
        const TouchPose pose =
            sample_touch_pose(limits, cell.block.faces[static_cast<std::size_t>(face)], chance);
        postures = inverse_kinematics(cell.arm.model, cell.arm.joint_ranges, pose.block_from_tip);
      }
      const auto pick = static_cast<std::size_t>(chance() * static_cast<double>(postures.size()));
      touches.push_back({.face = face, .joints = postures[pick]});
    }
  }
  return touches;
}

std::vector<Touch> all_planned_touches(const cell::Cell& cell, const cell::Recipe& recipe) {
  const auto plan = plan_touches(cell::planning_problems(cell, recipe));
  std::vector<Touch> touches;
  for (const PlannedTouch& planned : std::get<TouchPlan>(plan).touches)
    touches.push_back({.face = planned.face, .joints = planned.joints, .role = planned.role});
  return touches;
}

TipPostures postures_of_box(const cell::Cell& cell) {
  return derive_at_postures(cell.arm.model,
                            postures_in_box(cell.arm.model, cell.arm.joint_ranges, cell.workspace_box));
}

cell::JudgedTip tip_to_judge(const TipPostures& box, const IdentificationResult& result) {
  if (!result.uncertainty) return {};
  const TipSpread spread = box.spread(result.uncertainty->covariance()).value();
  return {.box_rms_m = spread.rms_m, .box_max_m = kTipCoverageFactor * spread.max_m};
}

std::vector<Touch> planned_touches(const cell::Cell& cell, const cell::Recipe& recipe) {
  std::vector<Touch> touches = all_planned_touches(cell, recipe);
  std::erase_if(touches, [](const Touch& touch) { return touch.role != TouchRole::kFit; });
  return touches;
}

std::vector<Touch> captured(const Truth& truth, std::vector<Touch> touches, double noise_m,
                            UniformChance& chance) {
  for (Touch& touch : touches) {
    ContactSurface plane = truth.contact_planes[static_cast<std::size_t>(touch.face)];
    plane.offset_m += noise_m * study::normal(chance);
    touch = moved_onto_plane(truth.arm, plane, touch);
  }
  return touches;
}

double tip_error_rms_m(const KinematicModel& model, const KinematicModel& truth,
                       std::span<const JointVector> postures) {
  const PreparedModel true_arm = prepare(truth);
  std::vector<Eigen::Vector3d> true_tips_m;
  for (const JointVector& joints : postures)
    true_tips_m.push_back(forward_chain(true_arm, joints).tip_in_block_m());
  return tip_error_rms_m(model, postures, true_tips_m);
}

double tip_error_rms_m(const KinematicModel& model, std::span<const JointVector> postures,
                       std::span<const Eigen::Vector3d> true_tips_m) {
  const PreparedModel prepared = prepare(model);
  double sum = 0.0;
  for (std::size_t i = 0; i < postures.size(); ++i)
    sum += (forward_chain(prepared, postures[i]).tip_in_block_m() - true_tips_m[i]).squaredNorm();
  return std::sqrt(sum / static_cast<double>(postures.size()));
}

std::vector<JointVector> joints_of(std::span<const Touch> touches) {
  std::vector<JointVector> postures;
  for (const Touch& touch : touches) postures.push_back(touch.joints);
  return postures;
}

std::vector<JointVector> postures_in(const JointRanges& ranges, int count) {
  std::vector<JointVector> postures;
  for (int i = 1; i <= count; ++i) postures.push_back(halton_posture(i, ranges));
  return postures;
}

}  // namespace calib::figures
