#include "calib_core/proof/tool_centre.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "calib_core/geometry/contact_surface.hpp"
#include "calib_core/kinematics/error_parameters.hpp"
#include "calib_core/proof/internal/column_space.hpp"
#include "calib_core/proof/internal/length_text.hpp"
#include "calib_core/proof/internal/whitened_rows.hpp"
#include "calib_core/proof/touch_rows.hpp"
#include "calib_core/uncertainty/tip_uncertainty.hpp"

namespace calib {
namespace {

constexpr int kFrameOfTool = 6;
constexpr int kCentreFreedom = 3;
constexpr int kCentreStepsMax = 20;
constexpr double kCentreStepSmall = 1e-10;    // metres
constexpr double kCentreAwayMaxMetres = 1.0;  // no tool is so large: the touches lead nowhere

ToolCentre at_centre(const Eigen::Vector3d& centre_m) {
  return Eigen::Isometry3d(Eigen::Translation3d(centre_m));
}

/// The calibrated arm as it is applied: theta6 is in the centre.
KinematicModel applied_arm(const CalibrationRecord& record) {
  KinematicModel arm = record.calibrated();
  arm.links[kFrameOfTool].theta_rad = record.problem().nominal.links[kFrameOfTool].theta_rad;
  return arm;
}

/// The ball of the calibration is not there.
bool is_of_ball(const ArtefactParameter& parameter) {
  return parameter.kind == ArtefactKind::kStylusRadius || parameter.kind == ArtefactKind::kPretravel;
}

/// Where the centre of the tip is when it touches.
std::vector<ContactSurface> tip_surfaces(const CalibrationRecord& record, const ToolTip& tip) {
  const Artefact& artefact = record.problem().artefact;
  Eigen::VectorXd errors = record.artefact_errors();
  for (Eigen::Index k = 0; k < errors.size(); ++k)
    if (is_of_ball(artefact.parameters[static_cast<std::size_t>(k)])) errors[k] = 0.0;
  std::vector<ContactSurface> surfaces;
  correct_contact_planes(artefact, errors, surfaces);
  for (ContactSurface& surface : surfaces) {
    surface.offset_m += tip.larger_m;
    surface.sideways = {};
  }
  return surfaces;
}

std::optional<ToolRefusal> find_bad_tool_touch(const CalibrationRecord& record,
                                               std::span<const Touch> touches) {
  if (std::ssize(touches) < kToolTouchesMin)
    return ToolRefusal{std::to_string(touches.size()) + " touches: a tool needs at least " +
                       std::to_string(kToolTouchesMin) + ", as three find its tip; touch more"};
  const auto faces = std::ssize(record.problem().artefact.contact_planes);
  for (std::size_t i = 0; i < touches.size(); ++i) {
    const std::string which = "touch " + std::to_string(i + 1);
    if (touches[i].face < 0 || touches[i].face >= faces)
      return ToolRefusal{which + " is on a plane that the block does not have; correct its plane number"};
    if (!touches[i].joints.allFinite())
      return ToolRefusal{which + " has a joint that is not a number; correct it or leave the touch out"};
  }
  return std::nullopt;
}

/// The centre by generalised least squares. The distances are H u + A c - e, u what the calibration left open
/// and e the noise, of covariance V = H C H^T + N; then c is G times minus the distances, and u is
/// C H^T V^-1 times what that leaves of them.
struct FoundCentre {
  Eigen::Vector3d centre_m;
  ToolRows rows;
  Eigen::MatrixXd covariance_m2;                     // V
  Eigen::Matrix<double, 3, Eigen::Dynamic> per_row;  // G
  Eigen::MatrixXd arm_per_row;  // of the errors that are taken over, a row per entry of ArmVector
};

/// theta6 is in the centre; what is beside rigid kinematics stays as the calibration has it.
bool is_taken_over(int arm_index) {
  return arm_index < kErrorParameterCount && arm_index != theta_index(kJointCount - 1);
}

void find_arm_errors(const CalibrationRecord& record, FoundCentre& found) {
  const Eigen::MatrixXd gain =
      (record.covariance().topRows<kArmParameterCount>() * found.rows.of_unknowns.transpose()) *
      Eigen::LLT<Eigen::MatrixXd>(found.covariance_m2)
          .solve(Eigen::MatrixXd::Identity(found.covariance_m2.rows(), found.covariance_m2.rows()));
  found.arm_per_row = gain - gain * found.rows.of_centre * found.per_row;
  for (int i = 0; i < kArmParameterCount; ++i)
    if (!is_taken_over(i)) found.arm_per_row.row(i).setZero();
}

/// Gauss-Newton from the drawing; nothing where the touches do not determine it.
std::optional<FoundCentre> find_centre(const CalibrationRecord& record, const ToolTip& tip,
                                       std::span<const Touch> touches) {
  FoundCentre found{.centre_m = tip.drawn_m, .rows = tool_rows(record, tip, tip.drawn_m, touches)};
  found.covariance_m2 = tool_covariance(record, tip, found.rows, touches);
  const Eigen::LLT<Eigen::MatrixXd> cholesky(found.covariance_m2);
  for (int step = 0; step < kCentreStepsMax; ++step) {
    if (column_space(found.rows.of_centre).cols() < kCentreFreedom) return std::nullopt;
    const Eigen::MatrixXd weighted = cholesky.solve(found.rows.of_centre);
    const Eigen::Matrix3d information = found.rows.of_centre.transpose() * weighted;
    found.per_row = information.ldlt().solve(weighted.transpose());
    const Eigen::Vector3d move_m = -found.per_row * found.rows.distances_m;
    if (!move_m.allFinite()) return std::nullopt;
    if (move_m.norm() < kCentreStepSmall) {
      find_arm_errors(record, found);
      return found;
    }
    found.centre_m += move_m;
    if ((found.centre_m - tip.drawn_m).norm() > kCentreAwayMaxMetres) return std::nullopt;
    found.rows = tool_rows(record, tip, found.centre_m, touches);
  }
  return std::nullopt;
}

/// Over the postures: of J u - (J K + R G) (H u - e), J the derivatives of the tip, K of the errors that were
/// taken over, R the turn of R_6. `in_world`: an error of the place has no effect.
std::optional<double> rms_over(const CalibrationRecord& record, const FoundCentre& found,
                               std::span<const JointVector> postures, bool in_world) {
  if (postures.empty()) return std::nullopt;
  const Eigen::MatrixXd of_arm = record.covariance().topLeftCorner<kArmParameterCount, kArmParameterCount>();
  const Eigen::MatrixXd with_rows =
      record.covariance().topRows<kArmParameterCount>() * found.rows.of_unknowns.transpose();
  TipPostures derived = derive_at_postures(applied_arm(record), postures, at_centre(found.centre_m));
  for (int i = 0; in_world && i < kErrorParameterCount; ++i)
    if (is_place_error(i)) derived.derivatives.col(i).setZero();
  const PreparedModel model = prepare(applied_arm(record));
  double squares_m2 = 0.0;
  for (Eigen::Index i = 0; i < std::ssize(postures); ++i) {
    const Chain chain = forward_chain(model, postures[static_cast<std::size_t>(i)]);
    const Eigen::MatrixXd tip = derived.derivatives.middleRows<3>(3 * i);
    const Eigen::MatrixXd undone =
        tip * found.arm_per_row + chain.block_from_frame[kFrameOfTool].linear() * found.per_row;
    squares_m2 += (tip * of_arm).cwiseProduct(tip).sum() -
                  2.0 * (tip * with_rows).cwiseProduct(undone).sum() +
                  (undone * found.covariance_m2).cwiseProduct(undone).sum();
  }
  return std::sqrt(std::max(0.0, squares_m2 / static_cast<double>(postures.size())));
}

void judge_tool(const ToolLimits& limits, ToolVerdict& verdict) {
  if (verdict.p < limits.p_min)
    verdict.reasons.push_back(
        "the touches contradict each other by more than noise and the calibration explain: the tool is loose "
        "or not rigid, a plane number is wrong, or the arm has changed; touch again");
  if (limits.rms_max_m && verdict.rms_over_postures_m && *verdict.rms_over_postures_m > *limits.rms_max_m)
    verdict.reasons.push_back("the tip is known to " + length_text(*verdict.rms_over_postures_m) +
                              " rms in the workspace box, which is more than " +
                              length_text(*limits.rms_max_m) + "; make cleaner contacts or more touches");
  verdict.passed = verdict.reasons.empty();
}

}  // namespace

ToolRows tool_rows(const CalibrationRecord& record, const ToolTip& tip, const Eigen::Vector3d& centre_m,
                   std::span<const Touch> touches) {
  const auto count = std::ssize(touches);
  const std::vector<ArtefactParameter>& parameters = record.problem().artefact.parameters;
  const std::vector<ContactSurface> surfaces = tip_surfaces(record, tip);
  const PreparedModel model = prepare(applied_arm(record));
  std::vector<JointVector> postures;
  for (const Touch& touch : touches) postures.push_back(touch.joints);
  const TipPostures derived = derive_at_postures(applied_arm(record), postures, at_centre(centre_m));
  ToolRows rows{.distances_m = Eigen::VectorXd(count),
                .of_centre = Eigen::MatrixXd(count, kCentreFreedom),
                .of_arm = Eigen::MatrixXd(count, kArmParameterCount),
                .of_joints = Eigen::MatrixXd(count, kJointCount),
                .of_unknowns = Eigen::MatrixXd::Zero(count, record.unknown_count())};
  for (Eigen::Index i = 0; i < count; ++i) {
    const Touch& touch = touches[static_cast<std::size_t>(i)];
    const auto face = static_cast<std::size_t>(touch.face);
    const Chain chain = forward_chain(model, touch.joints);
    const Eigen::Vector3d tip_m = chain.block_from_frame[kFrameOfTool] * centre_m;
    const Eigen::Vector3d normal = normal_at(surfaces[face], tip_m);
    rows.distances_m[i] = signed_distance_m(surfaces[face], tip_m);
    rows.of_centre.row(i) = normal.transpose() * chain.block_from_frame[kFrameOfTool].linear();
    rows.of_arm.row(i) = normal.transpose() * derived.derivatives.middleRows<3>(3 * i);
    for (std::size_t k = 0; k < parameters.size(); ++k) {
      if (is_of_ball(parameters[k])) continue;
      rows.of_unknowns(i, kArmParameterCount + static_cast<Eigen::Index>(k)) =
          parameters[k].shifts[face].at({tip_m, normal, Eigen::Vector3d::Zero()});  // of no other tip
    }
  }
  for (int joint = 0; joint < kJointCount; ++joint)
    rows.of_joints.col(joint) =
        model.model.gains[static_cast<std::size_t>(joint)] * rows.of_arm.col(theta_index(joint));
  rows.of_unknowns.leftCols<kArmParameterCount>() = rows.of_arm;
  return rows;
}

Eigen::MatrixXd tool_covariance(const CalibrationRecord& record, const ToolTip& tip, const ToolRows& rows,
                                std::span<const Touch> touches) {
  Eigen::MatrixXd covariance = rows.of_unknowns * record.covariance() * rows.of_unknowns.transpose() +
                               growth_covariance(record, tip.std_growth, rows.of_arm, rows.of_unknowns);
  covariance.array() += tip.std_radius_m * tip.std_radius_m;  // the same in every touch
  for (std::size_t i = 0; i < touches.size(); ++i) {
    const auto row = static_cast<Eigen::Index>(i);
    covariance(row, row) += record.noise_variance_m2(rows.of_joints.row(row), 1.0) +
                            std::pow(std::max(tip.noise_m, touches[i].deviation_m), 2);
  }
  return covariance;
}

std::variant<ToolVerdict, ToolRefusal> find_tool_centre(const CalibrationRecord& record, const ToolTip& tip,
                                                        std::span<const Touch> touches,
                                                        std::span<const JointVector> postures,
                                                        const ToolLimits& limits) {
  if (auto refusal = find_bad_tool_touch(record, touches)) return *refusal;
  const auto found = find_centre(record, tip, touches);
  if (!found)
    return ToolRefusal{
        "the touches do not determine where the tip is: touch three faces that are not parallel, or turn the "
        "wrist between the touches, and check the plane numbers"};
  Eigen::Index farthest = 0;
  const double far_m = found->rows.distances_m.cwiseAbs().maxCoeff(&farthest);
  if (far_m > kToolFarMetres)
    return ToolRefusal{"touch " + std::to_string(farthest + 1) + " is " + length_text(far_m) +
                       " off its plane: something else was touched; check the plane numbers and touch again"};
  const double way_m = (found->centre_m - tip.drawn_m).norm();
  if (way_m > kToolDrawnWithinMetres)
    return ToolRefusal{"the tip is " + length_text(way_m) +
                       " from where the cell's file has it: another tool is mounted, or its position_mm is "
                       "wrong; correct that and touch again"};
  ToolVerdict verdict{.centre_m = found->centre_m,
                      .covariance_m2 = found->per_row * found->covariance_m2 * found->per_row.transpose()};
  const Eigen::VectorXd& off_m = found->rows.distances_m;
  verdict.arm_errors = -found->arm_per_row * off_m;
  verdict.distances_m = off_m + found->rows.of_arm * verdict.arm_errors;
  verdict.degrees_of_freedom = static_cast<double>(std::ssize(touches) - kCentreFreedom);
  verdict.chi_square = off_m.dot(Eigen::LLT<Eigen::MatrixXd>(found->covariance_m2).solve(off_m));
  verdict.p = rest_p(verdict.chi_square, verdict.degrees_of_freedom, record.noise().degrees_of_freedom);
  verdict.rms_m = std::sqrt(verdict.distances_m.squaredNorm() / verdict.degrees_of_freedom);
  verdict.rms_over_postures_m = rms_over(record, *found, postures, false);
  verdict.rms_in_world_m = rms_over(record, *found, postures, true);
  judge_tool(limits, verdict);
  return verdict;
}

}  // namespace calib
