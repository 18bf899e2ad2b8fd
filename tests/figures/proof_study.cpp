#include "tests/figures/proof_study.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <numeric>
#include <optional>
#include <stdexcept>
#include <utility>

#include "calib_core/proof/detection_planning.hpp"
#include "config/moved_cell.hpp"
#include "config/stiffness_choice.hpp"
#include "tests/figures/simulated_cell.hpp"

namespace calib::figures {
namespace {

constexpr double kLiftMetres = 0.3;
constexpr double kStandHalfMetres = 0.15;
constexpr int kCubeFaces = 4;  // the plate stays where it is
/// The arm's warmth is known to this.
constexpr double kStdWarmthKelvins = 2.0;
constexpr double kWarmestKelvins = 8.0;
constexpr double kSecondsATouch = 7.5;
/// Lifting and locating the block.
constexpr double kLiftSeconds = 300.0;
/// A moved block is turned by this for each metre it is moved: 0.5 mrad with 0.1 mm.
constexpr double kTurnPerMetre = 5.0;
/// The scatter of a proof or check is not that of the calibration with the same seed.
constexpr std::uint64_t kProofScatter = 1'000'000, kCheckScatter = 10'000'000, kPairScatter = 100'000'000;

HiddenArm as_warm_as(HiddenArm arm, double rise_k) {
  arm.truth.warming.arm_rise_k = rise_k;
  arm.truth.warming.arm_time_constant_s = 1e-3;
  return arm;
}

cell::Cell with_lifted_block(const cell::Cell& cell, const Eigen::Isometry3d& calibrated_from_block) {
  cell::Cell lifted = cell::with_block_moved(cell, calibrated_from_block);
  double under_m = 0.0;  // y points down
  for (const Box& solid : cell.block.solids) under_m = std::max(under_m, solid.max_m.y());
  lifted.keep_out_boxes.push_back({"stand",
                                   {-kStandHalfMetres, under_m, -kStandHalfMetres},
                                   {kStandHalfMetres, under_m + kLiftMetres, kStandHalfMetres}});
  return lifted;
}

/// The planner's problem for touches that are chosen for what they show.
PlanningProblem to_choose_from(const cell::Cell& cell, const cell::Recipe& recipe, int faces) {
  PlanningProblem problem = cell::planning_problem(cell, recipe);
  std::erase_if(problem.requests, [faces](const TouchRequest& request) { return request.face >= faces; });
  problem.candidate_count = kDetectionCandidates;
  return problem;
}

std::vector<Touch> touches_of(const std::variant<TouchPlan, PlanningFailure>& outcome, double& seconds) {
  if (const auto* failure = std::get_if<PlanningFailure>(&outcome))
    throw std::runtime_error("no plan: " + failure->reason);
  const TouchPlan& plan = std::get<TouchPlan>(outcome);
  seconds = plan.duration_s();
  std::vector<Touch> touches;
  for (const PlannedTouch& planned : plan.touches)
    touches.push_back({.face = planned.face, .joints = planned.joints, .role = planned.role});
  return touches;
}

/// The calibration of a seed's cell; nothing when it did not converge. `scatter`: of its touches, in place of
/// the seed's.
std::optional<CalibrationRecord> calibrate(const StudiedCalibration& how, const HiddenArm& arm,
                                           std::uint64_t seed,
                                           std::optional<std::uint64_t> scatter = std::nullopt) {
  UniformChance chance(seed);
  HiddenCell hidden(how.cell, arm, chance);
  if (scatter) hidden.restart_scatter(*scatter);
  IdentificationProblem problem = cell::identification_problem(how.cell, how.recipe);
  make_run(hidden, how.planned, how.recipe, problem);
  const IdentificationResult result = identify(problem, how.recipe.identification);
  if (result.status != IdentificationStatus::kConverged || !result.uncertainty) return std::nullopt;
  return CalibrationRecord(problem, how.recipe.identification, result);
}

Eigen::Vector3d any_direction(UniformChance& chance) {
  return Eigen::Vector3d(study::normal(chance), study::normal(chance), study::normal(chance)).normalized();
}

/// What a check or a reference gave; one that was refused is a mistake of the study.
template <class Made>
Made made(const std::variant<Made, CheckRefusal>& outcome) {
  if (const auto* refusal = std::get_if<CheckRefusal>(&outcome)) throw std::runtime_error(refusal->message);
  return std::get<Made>(outcome);
}

int errors_index(const char* name) { return error_parameter_index(name).value(); }

/// A joint that slipped or a stylus that was bent, to either side.
HiddenArm with_cell_fault(HiddenArm arm, const CellFault& fault, double length_of_tool_m,
                          UniformChance& chance) {
  ErrorVector& errors = arm.truth.errors;
  if (fault.cause == CheckCause::kJoint)
    errors[theta_index(fault.joint - 1)] += std::copysign(fault.size, chance() - 0.5);
  if (fault.cause == CheckCause::kStylus) {
    const double direction_rad = 2.0 * std::numbers::pi * chance();
    errors[errors_index("d7")] += fault.size * std::cos(direction_rad);
    errors[errors_index("alpha7")] += fault.size * std::sin(direction_rad) / length_of_tool_m;
  }
  return arm;
}

}  // namespace

StudiedCalibration studied_calibration(const std::string& recipe, bool with_stiffness, Harmonics harmonics) {
  StudiedCalibration made{.cell = shipped_cell("demo"), .recipe = {}, .planned = {}};
  made.recipe = cell::with_stiffness(
      made.cell.recipes.at(recipe),
      with_stiffness ? cell::StiffnessChoice::kAuto : cell::StiffnessChoice::kOff, made.cell);
  made.recipe.identification.harmonics = harmonics;
  made.planned = all_planned_touches(made.cell, made.recipe);
  return made;
}

ProofStudy::ProofStudy(StudiedCalibration calibration, const HiddenArm& arm)
    : calibration_(std::move(calibration)) {
  place_.calibrated_from_block = Eigen::Translation3d(0.0, -kLiftMetres, 0.0);
  place_.std_growth = kStdWarmthKelvins * arm.truth.warming.arm_expansion_per_k;
  const cell::Cell& cell = calibration_.cell;
  lifted_ = with_lifted_block(cell, place_.calibrated_from_block);
  box_ = postures_of_box(cell).region();
  auto record = calibrate(calibration_, arm, 1);
  if (!record) throw std::runtime_error("the first calibration did not converge");
  const std::vector<ProofAlternative> alternatives = proof_alternatives(*record, box_);
  touches_ = touches_of(
      plan_proof(to_choose_from(lifted_, calibration_.recipe, kCubeFaces), *record, place_, alternatives),
      plan_s_);
  power_ = proof_power(*record, alternatives, place_, touches_);
  planned_for_.push_back(std::move(*record));
}

double ProofStudy::worth_m(const Eigen::VectorXd& displacement) const {
  const ArmVector of_arm = displacement.head<kArmParameterCount>();
  return box_.rms_m(ArmMatrix(of_arm * of_arm.transpose())).value();
}

HiddenArm ProofStudy::with_fault(HiddenArm arm, LeftOut left_out, UniformChance& chance) const {
  const CalibrationRecord& record = planned_for_.front();
  if (left_out == LeftOut::kNothing) return arm;
  Eigen::VectorXd displacement = Eigen::VectorXd::Zero(record.unknown_count());
  if (left_out == LeftOut::kDroop) {
    auto& compliance = arm.truth.droop.value().compliance_rad_per_nm;
    for (int joint = 0; joint < kJointCount; ++joint) {
      const double size = compliance[static_cast<std::size_t>(joint)];
      if (size != 0.0)
        displacement += size * record.displacement_by(nongeometric_index(compliance_position(joint)));
    }
    for (double& size : compliance) size *= kProofWorthMetres / worth_m(displacement);
    return arm;
  }
  auto& gears = arm.truth.harmonics_rad.emplace();
  for (int joint = 0; joint < kJointCount; ++joint) {
    const double phase_rad = 2.0 * std::numbers::pi * chance();
    CosSin& gear = gears[static_cast<std::size_t>(joint)];
    gear = {std::cos(phase_rad), std::sin(phase_rad)};
    const int cosine = nongeometric_index(harmonic_position(joint));
    displacement += gear.cos * record.displacement_by(cosine) + gear.sin * record.displacement_by(cosine + 1);
  }
  const double size = kProofWorthMetres / worth_m(displacement);
  for (CosSin& gear : gears) gear = {size * gear.cos, size * gear.sin};
  return arm;
}

ProofTally ProofStudy::tally(const HiddenArm& given, LeftOut left_out, int seeds,
                             std::uint64_t first_seed) const {
  ProofTally tally;
  UniformChance faults(first_seed);
  for (std::uint64_t seed = first_seed; seed < first_seed + static_cast<std::uint64_t>(seeds); ++seed) {
    const HiddenArm arm = with_fault(given, left_out, faults);
    const auto record = calibrate(calibration_, arm, seed);
    if (!record) {
      ++tally.not_calibrated;
      continue;
    }
    const cell::Warming& warming = arm.truth.warming;
    const double seconds = kSecondsATouch * static_cast<double>(calibration_.planned.size()) + kLiftSeconds;
    const double rise_k =
        warming.arm_rise_k *
        -std::expm1(-seconds / (warming.arm_time_constant_s > 0.0 ? warming.arm_time_constant_s : 1.0));
    UniformChance chance(seed);
    HiddenCell there(lifted_, as_warm_as(arm, rise_k), chance);
    there.restart_scatter(kProofScatter + seed);
    const auto outcome = prove(*record, place_, there.touch(touches_));
    const auto* verdict = std::get_if<ProofVerdict>(&outcome);
    if (!verdict) {
      tally.refusal = std::get<ProofRefusal>(outcome).message;
      ++tally.refused;
      continue;
    }
    ++tally.proofs;
    tally.seen += verdict->passed ? 0 : 1;
    tally.by_chance += verdict->p < ProofLimits{}.p_min ? 1 : 0;
    tally.by_rms += verdict->rms_m > ProofLimits{}.rms_max_m ? 1 : 0;
    tally.p.push_back(verdict->p);
    tally.rms_m.push_back(verdict->rms_m);
    tally.noise_m.push_back(record->noise().std_m);
  }
  return tally;
}

CheckStudy::CheckStudy(StudiedCalibration calibration, HiddenArm arm)
    : calibration_(std::move(calibration)), arm_(std::move(arm)) {
  const auto record = calibrate(calibration_, arm_, 1);
  if (!record) throw std::runtime_error("the first calibration did not converge");
  const auto faces = static_cast<int>(calibration_.cell.block.faces.size());
  touches_ =
      touches_of(plan_check(to_choose_from(calibration_.cell, calibration_.recipe, faces), *record), plan_s_);
}

std::vector<Touch> CheckStudy::touch(std::uint64_t seed, const CellFault& fault, double rise_k,
                                     std::uint64_t scatter, UniformChance& chance) const {
  const HiddenArm arm =
      with_cell_fault(as_warm_as(arm_, rise_k), fault, calibration_.cell.arm.model.links.back().r_m, chance);
  UniformChance same(seed);
  const auto made_in = [&](const cell::Cell& cell) {
    HiddenCell hidden(cell, arm, same);
    hidden.restart_scatter(scatter);
    return hidden.touch(touches_);
  };
  if (fault.cause != CheckCause::kBlock) return made_in(calibration_.cell);
  const Eigen::Isometry3d moved = Eigen::Translation3d(fault.size * any_direction(chance)) *
                                  Eigen::AngleAxisd(kTurnPerMetre * fault.size, any_direction(chance));
  return made_in(cell::with_block_moved(calibration_.cell, moved));
}

CheckReference CheckStudy::reference_at(const CalibrationRecord& record, std::uint64_t seed,
                                        std::span<const double> rises_k, std::uint64_t& scatter,
                                        UniformChance& chance) const {
  std::vector<ReferenceTime> times;
  for (const double rise_k : rises_k) times.push_back({touch(seed, {}, rise_k, ++scatter, chance)});
  return made(make_reference(record, times));
}

double CheckStudy::growth_seen(const CalibrationRecord& record, std::uint64_t seed, double reference_k,
                               double rise_k) const {
  std::uint64_t scatter = kCheckScatter + (kReferenceCount + 1) * seed;  // none of another seed's
  UniformChance chance(kCheckScatter + seed);
  std::array<double, kReferenceCount> rises_k{};
  rises_k.fill(reference_k);
  const CheckReference reference = reference_at(record, seed, rises_k, scatter, chance);
  return made(check(record, reference, touch(seed, {}, rise_k, ++scatter, chance))).growth;
}

CheckTally CheckStudy::tally(const CellFault& fault, int cells, int checks_each) const {
  CheckTally tally;
  const double expansion = arm_.truth.warming.arm_expansion_per_k;
  std::uint64_t scatter = kCheckScatter;
  for (std::uint64_t seed = 1; seed <= static_cast<std::uint64_t>(cells); ++seed) {
    const auto record = calibrate(calibration_, arm_, seed);
    if (!record) throw std::runtime_error("a calibration did not converge");
    UniformChance chance(kCheckScatter + seed);
    std::array<double, kReferenceCount> rises_k{};
    for (double& rise_k : rises_k) rise_k = kWarmestKelvins * chance();
    const double reference_k = std::reduce(rises_k.begin(), rises_k.end()) / kReferenceCount;
    const CheckReference reference = reference_at(*record, seed, rises_k, scatter, chance);
    for (int k = 0; k < checks_each; ++k) {
      const double rise_k = kWarmestKelvins * chance();
      const CheckVerdict verdict =
          made(check(*record, reference, touch(seed, fault, rise_k, ++scatter, chance)));
      ++tally.checks;
      tally.alarms += verdict.alarm ? 1 : 0;
      tally.named += verdict.alarm && verdict.cause == fault.cause && verdict.joint == fault.joint ? 1 : 0;
      tally.growth_error_ppm.push_back(1e6 * (verdict.growth - expansion * (rise_k - reference_k)));
    }
  }
  return tally;
}

ComparisonTally compare_calibrations(const StudiedCalibration& calibration, const HiddenArm& arm,
                                     const CellFault& fault, int pairs) {
  ComparisonTally tally;
  UniformChance chance(kPairScatter);
  const double expansion = arm.truth.warming.arm_expansion_per_k;
  const double length_of_tool_m = calibration.cell.arm.model.links.back().r_m;
  for (std::uint64_t seed = 1; seed <= static_cast<std::uint64_t>(pairs); ++seed) {
    const double before_k = kWarmestKelvins * chance(), after_k = kWarmestKelvins * chance();
    const auto before = calibrate(calibration, as_warm_as(arm, before_k), seed, kPairScatter + 2 * seed);
    const HiddenArm changed = with_cell_fault(as_warm_as(arm, after_k), fault, length_of_tool_m, chance);
    const auto after = calibrate(calibration, changed, seed, kPairScatter + 2 * seed + 1);
    if (!before || !after) throw std::runtime_error("a calibration did not converge");
    const auto outcome = compare(*before, *after);
    if (const auto* refusal = std::get_if<ComparisonRefusal>(&outcome))
      throw std::runtime_error(refusal->message);
    const Comparison& made = std::get<Comparison>(outcome);
    ++tally.pairs;
    tally.arm_changed += made.arm.has_changed() ? 1 : 0;
    tally.tool_changed += made.tool.has_changed() ? 1 : 0;
    tally.growth_error_ppm.push_back(1e6 * (made.growth - expansion * (after_k - before_k)));
    tally.arm_chi_square_per_degree.push_back(made.arm.chi_square / made.arm.degrees_of_freedom);
  }
  return tally;
}

}  // namespace calib::figures
