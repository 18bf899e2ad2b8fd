#include "calib_core/proof/check.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "calib_core/numerics/distributions.hpp"
#include "calib_core/proof/check_effects.hpp"
#include "calib_core/proof/internal/whitened_rows.hpp"
#include "calib_core/proof/touch_rows.hpp"

namespace calib {
namespace {

std::optional<CheckRefusal> find_bad_first(const CalibrationRecord& record, std::span<const Touch> touches) {
  const auto faces = std::ssize(record.problem().artefact.contact_planes);
  if (std::ssize(touches) < kCheckTouchCount)
    return CheckRefusal{std::to_string(touches.size()) + " touches: a check has at least " +
                        std::to_string(kCheckTouchCount) + "; make those of its plan"};
  for (std::size_t i = 0; i < touches.size(); ++i) {
    if (touches[i].face >= 0 && touches[i].face < faces) continue;
    return CheckRefusal{"touch " + std::to_string(i + 1) +
                        " is on a plane that the block does not have; correct its plane number"};
  }
  return std::nullopt;
}

Eigen::VectorXd distances_then_m(const CalibrationRecord& record, const ReferenceTime& time) {
  if (time.contact_planes.empty()) return touch_rows(record, record.calibrated(), time.touches).distances_m;
  CalibrationRecord then = record;
  then.meet_at(time.contact_planes);
  return touch_rows(then, then.calibrated(), time.touches).distances_m;
}

/// Of one or more; the noise is known from two on.
std::variant<CheckReference, CheckRefusal> mean_of(const CalibrationRecord& record,
                                                   std::span<const ReferenceTime> times) {
  const std::vector<Touch>& first = times.front().touches;
  if (auto refusal = find_bad_first(record, first)) return *refusal;
  Eigen::MatrixXd distances_m(std::ssize(first), std::ssize(times));
  for (std::size_t k = 0; k < times.size(); ++k) {
    if (auto refusal = why_other_touches(record.problem().nominal, first, times[k].touches))
      return CheckRefusal{"check " + std::to_string(k + 1) + " of the reference: " + refusal->message};
    distances_m.col(static_cast<Eigen::Index>(k)) = distances_then_m(record, times[k]);
  }
  CheckReference reference{
      .touches = first, .distances_m = distances_m.rowwise().mean(), .count = static_cast<int>(times.size())};
  if (times.size() == 1) return reference;
  const Eigen::VectorXd growth =
      check_effects(record, touch_rows(record, record.calibrated(), first)).of_growth.normalized();
  Eigen::MatrixXd scatter = distances_m.colwise() - reference.distances_m;
  scatter -= growth * (growth.transpose() * scatter).eval();
  const double degrees = static_cast<double>((distances_m.rows() - 1) * (distances_m.cols() - 1));
  reference.noise = {std::sqrt(scatter.squaredNorm() / degrees), degrees};
  if (!(reference.noise.std_m > kProbeScatterMinMetres))
    return CheckRefusal{
        "the touches of the reference do not scatter at all: they are copies, or not of a probe; repeat "
        "them"};
  return reference;
}

/// Faults that may explain a check, with what the touches show of each.
struct Explanation {
  CheckCause cause = CheckCause::kJoint;
  int joint = 0;
  Eigen::MatrixXd effects;
};

std::vector<Explanation> explanations(const CheckEffects& effects) {
  std::vector<Explanation> all;
  for (std::size_t k = 0; k < kCheckedJoints.size(); ++k)
    all.push_back(
        {CheckCause::kJoint, kCheckedJoints[k], effects.of_joints.col(static_cast<Eigen::Index>(k))});
  all.push_back({CheckCause::kStylus, 0, effects.of_stylus});
  all.push_back({CheckCause::kBlock, 0, effects.of_block});
  return all;
}

Eigen::MatrixXd beside(const Eigen::MatrixXd& first, const Eigen::MatrixXd& second) {
  Eigen::MatrixXd both(first.rows(), first.cols() + second.cols());
  both << first, second;
  return both;
}

/// The cause that explains the changes with the least: by the sum of squares it leaves, and what as many
/// parameters cost (Schwarz). A larger one is not blamed where a smaller one does.
void find_cause(const Eigen::MatrixXd& covariance, const CheckEffects& effects, double noise_degrees,
                CheckVerdict& verdict) {
  const double cost_each = std::log(static_cast<double>(verdict.changes_m.size()));
  double least = std::numeric_limits<double>::infinity();
  double p_left = 0.0;
  for (const Explanation& explanation : explanations(effects)) {
    const WhitenedRows white(covariance, beside(effects.of_growth, explanation.effects));
    const double left = white.rest(verdict.changes_m).squaredNorm();
    const auto degrees = static_cast<double>(white.degrees());
    const double score = left + cost_each * (verdict.degrees_of_freedom - degrees);
    if (score >= least) continue;
    least = score;
    p_left = f_survival(left / degrees, degrees, noise_degrees);
    verdict.cause = explanation.cause;
    verdict.joint = explanation.joint;
  }
  if (p_left >= kCauseP) return;
  verdict.cause = CheckCause::kUnknown;
  verdict.joint = 0;
}

/// An estimate of one effect from what is left of it and of the changes, which fall where the effect rises.
struct Size {
  double value = 0.0, std = 0.0;
};
Size size_of(const WhitenedRows& white, const Eigen::VectorXd& effect, const Eigen::VectorXd& changes_m) {
  const Eigen::VectorXd rest = white.rest(effect);
  return {-rest.dot(white.rest(changes_m).col(0)) / rest.squaredNorm(), 1.0 / rest.norm()};
}

}  // namespace

std::optional<CheckRefusal> why_other_touches(const KinematicModel& arm, std::span<const Touch> reference,
                                              std::span<const Touch> touches) {
  if (touches.size() != reference.size())
    return CheckRefusal{std::to_string(touches.size()) + " touches where the reference has " +
                        std::to_string(reference.size()) +
                        ": make the touches of the check's plan, all of "
                        "them and in its order"};
  const PreparedModel prepared = prepare(arm);
  for (std::size_t i = 0; i < touches.size(); ++i) {
    const std::string which = "touch " + std::to_string(i + 1);
    if (!touches[i].joints.allFinite())
      return CheckRefusal{which + " has a joint that is not a number; correct it or touch again"};
    const bool is_there = touches[i].face == reference[i].face &&
                          (forward_chain(prepared, touches[i].joints).tip_in_block_m() -
                           forward_chain(prepared, reference[i].joints).tip_in_block_m())
                                  .norm() < kSameTouchMetres;
    if (!is_there)
      return CheckRefusal{which +
                          " is not where the reference has it: make the touches of the check's plan "
                          "in its order, or take a new reference when the block was moved on purpose"};
  }
  return std::nullopt;
}

std::optional<CheckRefusal> why_no_reference(const CalibrationRecord& record,
                                             std::span<const ReferenceTime> times) {
  const auto mean = mean_of(record, times);
  const auto* refusal = std::get_if<CheckRefusal>(&mean);
  return refusal ? std::optional(*refusal) : std::nullopt;
}

std::variant<CheckReference, CheckRefusal> make_reference(const CalibrationRecord& record,
                                                          std::span<const ReferenceTime> times) {
  if (std::ssize(times) < kReferenceCount)
    return CheckRefusal{std::to_string(times.size()) + " checks: a reference is the mean of " +
                        std::to_string(kReferenceCount) + "; repeat the check"};
  return mean_of(record, times);
}

std::variant<CheckVerdict, CheckRefusal> check(const CalibrationRecord& record,
                                               const CheckReference& reference,
                                               std::span<const Touch> touches) {
  if (auto refusal = why_other_touches(record.problem().nominal, reference.touches, touches)) return *refusal;
  const TouchRows rows = touch_rows(record, record.calibrated(), touches);
  const CheckEffects effects = check_effects(record, rows);
  CheckVerdict verdict{.changes_m = rows.distances_m - reference.distances_m};
  const double variance_m2 = reference.noise.std_m * reference.noise.std_m * (1.0 + 1.0 / reference.count);
  const Eigen::Index count = verdict.changes_m.size();
  const Eigen::MatrixXd covariance = variance_m2 * Eigen::MatrixXd::Identity(count, count);
  const double noise_degrees = reference.noise.degrees_of_freedom;

  const WhitenedRows beside_nothing(covariance, Eigen::MatrixXd(count, 0));
  const Size growth = size_of(beside_nothing, effects.of_growth, verdict.changes_m);
  verdict.growth = growth.value;
  verdict.std_growth = growth.std;

  const WhitenedRows white(covariance, effects.of_growth);
  verdict.degrees_of_freedom = static_cast<double>(white.degrees());
  verdict.chi_square = white.rest(verdict.changes_m).squaredNorm();
  verdict.rms_m = std::sqrt(variance_m2 * verdict.chi_square / verdict.degrees_of_freedom);
  verdict.p =
      f_survival(verdict.chi_square / verdict.degrees_of_freedom, verdict.degrees_of_freedom, noise_degrees);
  for (std::size_t k = 0; k < kCheckedJoints.size(); ++k) {
    const Size offset =
        size_of(white, effects.of_joints.col(static_cast<Eigen::Index>(k)), verdict.changes_m);
    verdict.joints[k] = {kCheckedJoints[k], offset.value, offset.std};
    const double p = f_survival(std::pow(offset.value / offset.std, 2), 1.0, noise_degrees);
    verdict.joint_p = std::min(verdict.joint_p, static_cast<double>(kCheckedJoints.size()) * p);
  }
  verdict.alarm = verdict.p < kCheckAlarmP || verdict.joint_p < kCheckAlarmP;
  if (verdict.alarm) find_cause(covariance, effects, noise_degrees, verdict);
  return verdict;
}

}  // namespace calib
