#include "calib_core/proof/proof.hpp"

#include <algorithm>
#include <cmath>

#include "calib_core/estimation/block_registration.hpp"
#include "calib_core/numerics/decompositions.hpp"
#include "calib_core/numerics/distributions.hpp"
#include "calib_core/proof/internal/column_space.hpp"
#include "calib_core/proof/internal/length_text.hpp"
#include "calib_core/proof/internal/whitened_rows.hpp"
#include "calib_core/proof/touch_rows.hpp"

namespace calib {
namespace {

constexpr int kPlaceStepsMax = 30;
constexpr double kPlaceStepSmall = 1e-9;  // metres and radians
constexpr int kPoseFreedom = 6;

std::optional<ProofRefusal> find_bad_touch(const CalibrationRecord& record, std::span<const Touch> touches) {
  if (std::ssize(touches) < kProofTouchesMin)
    return ProofRefusal{std::to_string(touches.size()) + " touches: a proof needs at least " +
                        std::to_string(kProofTouchesMin) + ", as six find the block; touch more"};
  const auto faces = std::ssize(record.problem().artefact.contact_planes);
  for (std::size_t i = 0; i < touches.size(); ++i) {
    const std::string which = "touch " + std::to_string(i + 1);
    if (touches[i].face < 0 || touches[i].face >= faces)
      return ProofRefusal{which + " is on a plane that the block does not have; correct its plane number"};
    if (!touches[i].joints.allFinite())
      return ProofRefusal{which + " has a joint that is not a number; correct it or leave the touch out"};
  }
  return std::nullopt;
}

/// The arm before the block at the pose that the touches fit best.
struct Located {
  KinematicModel arm;
  TouchRows rows;
};

/// Gauss-Newton for the place; nothing where it does not end.
std::optional<Located> locate(const CalibrationRecord& record, KinematicModel arm,
                              std::span<const Touch> touches) {
  std::vector<int> place;
  for (int i = 0; i < kErrorParameterCount; ++i) {
    if (is_place_error(i)) place.push_back(i);
  }
  for (int step = 0; step < kPlaceStepsMax; ++step) {
    TouchRows rows = touch_rows(record, arm, touches);
    const Eigen::VectorXd move = least_squares_solution(rows.of_place, -rows.distances_m);
    if (!move.allFinite()) return std::nullopt;
    if (move.norm() < kPlaceStepSmall) return Located{std::move(arm), std::move(rows)};
    ErrorVector errors = ErrorVector::Zero();
    errors(place) = move;
    arm = apply(arm, errors);
  }
  return std::nullopt;
}

/// Distances without what the place, and the growth where it may differ, make of them.
Eigen::VectorXd at_best_pose(const CalibrationRecord& record, const ProofPlace& place, const TouchRows& rows,
                             Eigen::Index& degrees) {
  Eigen::MatrixXd free = rows.of_place;
  if (place.std_growth > 0.0) {
    free.conservativeResize(Eigen::NoChange, free.cols() + 1);
    free.rightCols<1>() = growth_effect(record, rows.of_arm);
  }
  const Eigen::MatrixXd basis = column_space(free);
  degrees = basis.rows() - basis.cols();
  return rows.distances_m - basis * (basis.transpose() * rows.distances_m);
}

void judge(const ProofLimits& limits, ProofVerdict& verdict) {
  if (verdict.p < limits.p_min)
    verdict.reasons.push_back(
        "the touches scatter about the block by more than noise and the model's own uncertainty explain: the "
        "model lacks something, or something has changed since the calibration");
  if (verdict.rms_m > limits.rms_max_m)
    verdict.reasons.push_back("the touches are off by " + length_text(verdict.rms_m) + " rms, more than " +
                              length_text(limits.rms_max_m));
  verdict.passed = verdict.reasons.empty();
}

}  // namespace

std::variant<ProofVerdict, ProofRefusal> prove(const CalibrationRecord& record, const ProofPlace& place,
                                               std::span<const Touch> touches, const ProofLimits& limits) {
  if (auto refusal = find_bad_touch(record, touches)) return *refusal;
  const auto located = locate(record, arm_at(record.calibrated(), place.calibrated_from_block), touches);
  if (!located || column_space(located->rows.of_place).cols() < kPoseFreedom)
    return ProofRefusal{
        "the touches do not determine where the block stands: touch three faces that are not parallel, three "
        "touches on one and two on another, and check the plane numbers"};
  Eigen::Index farthest = 0;
  if (located->rows.distances_m.cwiseAbs().maxCoeff(&farthest) > kProofFarMetres)
    return ProofRefusal{"touch " + std::to_string(farthest + 1) + " is " +
                        length_text(std::abs(located->rows.distances_m[farthest])) +
                        " off its plane: something else was touched, or the block's place is not the one "
                        "given; locate the block and check the plane numbers"};
  ProofVerdict verdict;
  verdict.calibrated_from_block = block_pose_of(record.calibrated()) * block_pose_of(located->arm).inverse();
  if (verdict.calibrated_from_block.translation().norm() < kProofWayMinMetres)
    return ProofRefusal{"the block stands within " + length_text(kProofWayMinMetres) +
                        " of where the arm was calibrated, which proves nothing: lift it by 300 mm"};
  const WhitenedRows white(proof_covariance(record, place, located->rows, touches), located->rows.of_place);
  Eigen::Index degrees = 0;
  verdict.distances_m = at_best_pose(record, place, located->rows, degrees);
  verdict.degrees_of_freedom = static_cast<double>(white.degrees());
  verdict.chi_square = white.rest(located->rows.distances_m).squaredNorm();
  verdict.p = rest_p(verdict.chi_square, verdict.degrees_of_freedom, record.noise().degrees_of_freedom);
  verdict.rms_m = std::sqrt(verdict.distances_m.squaredNorm() / static_cast<double>(degrees));
  judge(limits, verdict);
  return verdict;
}

Eigen::MatrixXd proof_covariance(const CalibrationRecord& record, const ProofPlace& place,
                                 const TouchRows& rows, std::span<const Touch> touches) {
  Eigen::MatrixXd covariance = rows.of_unknowns * record.covariance() * rows.of_unknowns.transpose() +
                               growth_covariance(record, place.std_growth, rows.of_arm, rows.of_unknowns);
  for (std::size_t i = 0; i < touches.size(); ++i) {
    const auto row = static_cast<Eigen::Index>(i);
    covariance(row, row) += record.noise_variance_m2(
        rows.of_joints.row(row), noise_factor(touches[i], record.problem().touch_noise_m));
  }
  return covariance;
}

std::vector<ProofPower> proof_power(const CalibrationRecord& record,
                                    std::span<const ProofAlternative> alternatives, const ProofPlace& place,
                                    std::span<const Touch> touches, const ProofLimits& limits) {
  const TouchRows rows =
      touch_rows(record, arm_at(record.calibrated(), place.calibrated_from_block), touches);
  const WhitenedRows white(proof_covariance(record, place, rows, touches), rows.of_place);
  std::vector<ProofPower> powers;
  for (const ProofAlternative& alternative : alternatives) {
    ProofPower power{.name = alternative.name};
    power.noncentrality = white.rest(rows.of_unknowns * alternative.displacements).squaredNorm();
    power.power = chi_square_power(limits.p_min, static_cast<double>(white.degrees()), power.noncentrality);
    powers.push_back(std::move(power));
  }
  return powers;
}

}  // namespace calib
