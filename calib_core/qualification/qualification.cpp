#include "calib_core/qualification/qualification.hpp"

#include <algorithm>
#include <cmath>

#include "calib_core/geometry/sideways_pretravel.hpp"
#include "calib_core/numerics/decompositions.hpp"
#include "calib_core/numerics/distributions.hpp"
#include "calib_core/proof/touch_rows.hpp"
#include "calib_core/qualification/turned_touches.hpp"

namespace calib {
namespace {

constexpr Eigen::Index kTurnUnknowns = 5;  // c, run-out, lobes
constexpr double kLeastShareOfOneM = 1e-12;

/// Of c, e_x, e_y, l_c and l_s, by the push on the ball in R_7.
Eigen::Matrix<double, 1, kTurnUnknowns> turn_row(const Eigen::Vector3d& push) {
  const Eigen::Vector3d shapes = sideways_shapes(push);
  Eigen::Matrix<double, 1, kTurnUnknowns> row;
  row << 1.0, -push.x(), -push.y(), -shapes[1], -shapes[2];
  return row;
}

std::optional<QualificationRefusal> find_bad(const QualificationProblem& problem,
                                             std::span<const Touch> touches) {
  for (std::size_t i = 0; i < touches.size(); ++i) {
    const std::string which = "touch " + std::to_string(i + 1);
    if (touches[i].face < 0 || touches[i].face >= std::ssize(problem.surfaces))
      return QualificationRefusal{which +
                                  " is on a plane that the block does not have; correct its plane number"};
    if (!touches[i].joints.allFinite())
      return QualificationRefusal{which + " has a joint that is not a number; qualify once more"};
  }
  return std::nullopt;
}

/// The turns with their rows.
struct Turns {
  Eigen::MatrixXd rows;
  Eigen::VectorXd distances_m;  // by the nominal arm and the pre-travel of the probe's file
};

Turns turns_of(const QualificationProblem& problem, std::span<const Touch> touches,
               const std::vector<std::size_t>& members) {
  const PreparedModel prepared = prepare(problem.nominal);
  const auto count = std::ssize(members);
  Turns turns{Eigen::MatrixXd(count, kTurnUnknowns), Eigen::VectorXd(count)};
  for (Eigen::Index i = 0; i < count; ++i) {
    const Touch& touch = touches[members[static_cast<std::size_t>(i)]];
    const ContactSurface& surface = problem.surfaces[static_cast<std::size_t>(touch.face)];
    const Eigen::Isometry3d tip = forward_chain(prepared, touch.joints).block_from_frame.back();
    turns.distances_m[i] = signed_distance_m(surface, tip);
    turns.rows.row(i) = turn_row(tip.linear().transpose() * normal_at(surface, tip.translation()));
  }
  return turns;
}

/// Sum of the squares about the mean.
double squares_about_mean(const Eigen::VectorXd& values, const std::vector<Eigen::Index>& chosen) {
  const Eigen::VectorXd part = values(chosen);
  return (part.array() - part.mean()).square().sum();
}

/// Where the repeats are among the turns.
std::vector<Eigen::Index> places_of(const TurnedTouches& turned) {
  std::vector<Eigen::Index> places;
  for (std::size_t i = 0; i < turned.all.size(); ++i) {
    if (std::ranges::find(turned.repeats, turned.all[i]) != turned.repeats.end())
      places.push_back(static_cast<Eigen::Index>(i));
  }
  return places;
}

TouchNoise scatter_at(const Turns& turns, const std::vector<Eigen::Index>& repeats) {
  const auto degrees = static_cast<double>(std::ssize(repeats) - 1);
  return {std::sqrt(squares_about_mean(turns.distances_m, repeats) / degrees), degrees};
}

AcrossStylus across(const Eigen::VectorXd& solution, const Eigen::MatrixXd& covariance, Eigen::Index first) {
  return {solution.segment<2>(first), covariance.block<2, 2>(first, first)};
}

/// The chance of an offset across the stylus so large, by F with the freedom of the noise.
double chance_of(const AcrossStylus& offset, double degrees) {
  const double square = offset.value_m.dot(offset.covariance_m2.ldlt().solve(offset.value_m));
  return f_survival(square / 2.0, 2.0, degrees);
}

/// The ball against where the calibrated arm has it: the same rows, by that arm.
StylusChange change_of(const CalibrationRecord& record, const std::vector<Touch>& turned,
                       const Eigen::MatrixXd& inverse, const TouchNoise& noise) {
  const TouchRows rows = touch_rows(record, record.calibrated(), turned);
  Eigen::MatrixXd covariance = rows.of_unknowns * record.covariance() * rows.of_unknowns.transpose();
  covariance.diagonal().array() += noise.std_m * noise.std_m;
  StylusChange change{across(inverse * rows.distances_m, inverse * covariance * inverse.transpose(), 1)};
  change.p = chance_of(change.offset, noise.degrees_of_freedom);
  return change;
}

/// The mean of some touches of one face, as the calibrated arm measures it.
struct MeanReading {
  double distance_m = 0.0;
  Eigen::VectorXd of_unknowns;
  double of_growth_m = 0.0;
  double noise_variance_m2 = 0.0;
};

MeanReading mean_of(const CalibrationRecord& record, const TouchRows& rows,
                    const std::vector<Eigen::Index>& chosen) {
  MeanReading mean{.of_unknowns = rows.of_unknowns(chosen, Eigen::all).colwise().mean().transpose()};
  mean.distance_m = rows.distances_m(chosen).mean();
  mean.of_growth_m = growth_effect(record, rows.of_arm)(chosen).mean();
  // The gears err alike in touches of one posture, so that their mean is no better than one of them.
  for (const Eigen::Index touch : chosen)
    mean.noise_variance_m2 =
        std::max(mean.noise_variance_m2, record.noise_variance_m2(rows.of_joints.row(touch), 1.0));
  return mean;
}

std::vector<Eigen::Index> touches_on(std::span<const Touch> touches, int face) {
  std::vector<Eigen::Index> found;
  for (std::size_t i = 0; i < touches.size(); ++i) {
    if (touches[i].face == face) found.push_back(static_cast<Eigen::Index>(i));
  }
  return found;
}

/// `others`: the touches that are no turns, with their rows.
std::vector<StepReading> steps_of(const QualificationProblem& problem, const std::vector<Touch>& others,
                                  const TouchRows& rows) {
  const CalibrationRecord& record = *problem.record;
  std::vector<StepReading> steps;
  for (const KnownLength& length : problem.lengths) {
    const auto [from, to] = length.faces;
    const auto at_from = touches_on(others, from), at_to = touches_on(others, to);
    if (at_from.empty() || at_to.empty()) continue;
    const MeanReading first = mean_of(record, rows, at_from), second = mean_of(record, rows, at_to);
    const ContactSurface& one = problem.surfaces[static_cast<std::size_t>(from)];
    const ContactSurface& other = problem.surfaces[static_cast<std::size_t>(to)];
    // Outwards is longer on the face that the other one lies behind.
    const double of_second = one.outward.dot(other.outward) < 0.0 ? 1.0 : -1.0;
    const double way = of_second < 0.0 && one.offset_m < other.offset_m ? -1.0 : 1.0;
    const Eigen::VectorXd unknowns = first.of_unknowns + of_second * second.of_unknowns;
    const double growth_m = problem.std_growth * (first.of_growth_m + of_second * second.of_growth_m);
    StepReading step{.faces = length.faces,
                     .known_m = length.value_m,
                     .error_m = way * (first.distance_m + of_second * second.distance_m)};
    step.std_m = std::sqrt(unknowns.dot(record.covariance() * unknowns) + growth_m * growth_m +
                           first.noise_variance_m2 + second.noise_variance_m2);
    step.p = chi_square_survival(std::pow(step.error_m / step.std_m, 2), 1.0);
    steps.push_back(step);
  }
  return steps;
}

void judge_size(QualificationCriterion::Kind kind, double value_m, double std_m,
                const std::optional<double>& limit_m, bool guarded, QualificationVerdict& verdict) {
  constexpr double kCoverage = 2.0;
  verdict.criteria.push_back(
      {.kind = kind,
       .value = value_m,
       .limit = limit_m,
       .std = std_m,
       .passed = !limit_m || value_m + (guarded ? kCoverage * std_m : 0.0) <= *limit_m});
}

void judge_chance(QualificationCriterion::Kind kind, double p, double p_min, QualificationVerdict& verdict) {
  verdict.criteria.push_back({.kind = kind, .value = p, .limit = p_min, .passed = p >= p_min});
}

std::string planes(const std::array<int, 2>& faces) {
  return "planes " + std::to_string(faces[0] + 1) + " and " + std::to_string(faces[1] + 1);
}

std::string reason_of(const QualificationCriterion& criterion) {
  using Kind = QualificationCriterion::Kind;
  switch (criterion.kind) {
    case Kind::kScatter:
      return "the touches of one place scatter by more than is allowed: tighten the stylus, clean ball and "
             "face, look at the probe's cable, and qualify once more";
    case Kind::kRunOut:
      return "the ball runs out by more than is allowed: straighten or replace the stylus, or correct "
             "frame 7 of the cell's file, and qualify once more";
    case Kind::kLobes:
      return "the pre-travel depends on the direction of the push by more than is allowed: write the lobes "
             "into the probe's file, or have the probe adjusted";
    case Kind::kTurns:
      return "the turned touches differ by what neither run-out nor lobes nor noise explain: look for a "
             "loose stylus, dirt on the ball or on the face, and qualify once more";
    case Kind::kChange:
      return "the ball is not where it was when the arm was calibrated: the stylus has bent or was changed; "
             "put the right one in, or calibrate anew";
    case Kind::kStep:
      return "the calibrated arm measures the known length of " + planes(criterion.faces) +
             " wrong: the ball, the block or the arm is not as it was calibrated; check which, and calibrate "
             "anew";
  }
  return {};
}

void judge(const QualificationLimits& limits, QualificationVerdict& verdict) {
  using Kind = QualificationCriterion::Kind;
  const double degrees = verdict.scatter.degrees_of_freedom;
  const double square = degrees * std::pow(verdict.scatter.std_m / limits.scatter_max_m, 2);
  verdict.criteria.push_back({.kind = Kind::kScatter,
                              .value = verdict.scatter.std_m,
                              .limit = limits.scatter_max_m,
                              .std = verdict.scatter.std_m / std::sqrt(2.0 * degrees),
                              .passed = chi_square_survival(square, degrees) >= limits.p_min});
  judge_size(Kind::kRunOut, verdict.run_out.size_m(), verdict.run_out.std_size_m(), limits.run_out_max_m,
             limits.guarded, verdict);
  judge_size(Kind::kLobes, verdict.lobes.size_m(), verdict.lobes.std_size_m(), limits.lobes_max_m,
             limits.guarded, verdict);
  judge_chance(Kind::kTurns, verdict.turns_p, limits.p_min, verdict);
  if (verdict.change) judge_chance(Kind::kChange, verdict.change->p, limits.p_min, verdict);
  for (const StepReading& step : verdict.steps) {
    judge_size(Kind::kStep, std::abs(step.error_m), step.std_m, limits.step_max_m, limits.guarded, verdict);
    verdict.criteria.back().faces = step.faces;
    if (step.p < limits.p_min) verdict.criteria.back().passed = false;
  }
  for (const QualificationCriterion& criterion : verdict.criteria)
    if (!criterion.passed) verdict.reasons.push_back(reason_of(criterion));
  verdict.passed = verdict.reasons.empty();
}

/// What only a calibrated arm tells.
void add_of_calibration(const QualificationProblem& problem, std::span<const Touch> touches,
                        const TurnedTouches& turned, const Eigen::MatrixXd& inverse, const TouchNoise& noise,
                        QualificationVerdict& verdict) {
  std::vector<Touch> of_turns, others;
  std::vector<std::size_t> where;
  for (const std::size_t i : turned.all) of_turns.push_back(touches[i]);
  verdict.change = change_of(*problem.record, of_turns, inverse, noise);
  for (std::size_t i = 0; i < touches.size(); ++i) {
    if (std::ranges::find(turned.all, i) != turned.all.end()) continue;
    others.push_back(touches[i]);
    where.push_back(i);
  }
  if (others.empty()) return;
  const TouchRows rows = touch_rows(*problem.record, problem.record->calibrated(), others);
  for (std::size_t i = 0; i < others.size(); ++i)
    verdict.deviations_m[where[i]] = rows.distances_m[static_cast<Eigen::Index>(i)];
  verdict.steps = steps_of(problem, others, rows);
}

std::optional<QualificationRefusal> refuse_few(const TurnedTouches& turned) {
  if (turned.directions >= kTurnCount && std::ssize(turned.repeats) >= kRepeatCount) return std::nullopt;
  return QualificationRefusal{
      std::to_string(turned.directions) + " turns of the stylus and " +
      std::to_string(turned.repeats.size()) + " touches of one of them: " + std::to_string(kTurnCount) +
      " and " + std::to_string(kRepeatCount) + " are needed; qualify once more and leave no touch out"};
}

}  // namespace

double AcrossStylus::std_size_m() const {
  const double size = size_m();
  const Eigen::Vector2d along =
      size > kLeastShareOfOneM ? Eigen::Vector2d(value_m / size) : Eigen::Vector2d::UnitX();
  return std::sqrt(along.dot(covariance_m2 * along));
}

double AcrossStylus::direction_rad() const { return std::atan2(value_m.y(), value_m.x()); }

std::variant<QualificationVerdict, QualificationRefusal> qualify(const QualificationProblem& problem,
                                                                 std::span<const Touch> touches) {
  if (auto refusal = find_bad(problem, touches)) return *refusal;
  const TurnedTouches turned = turned_touches(problem.nominal, problem.surfaces, touches);
  if (auto refusal = refuse_few(turned)) return *refusal;
  const Turns turns = turns_of(problem, touches, turned.all);
  const auto repeats = places_of(turned);
  QualificationVerdict verdict{.scatter = scatter_at(turns, repeats)};
  if (is_implausibly_small(verdict.scatter, kProbeScatterMinMetres))
    return QualificationRefusal{
        "the ten touches of one place are copies of each other: the latch does not follow the contact; look "
        "at the wiring of the probe and qualify once more"};
  const Eigen::MatrixXd inverse = pseudo_inverse(turns.rows);
  const Eigen::VectorXd solution = inverse * turns.distances_m;
  const Eigen::VectorXd rest = turns.distances_m - turns.rows * solution;
  const double pure = squares_about_mean(turns.distances_m, repeats);
  const double degrees = static_cast<double>(rest.size() - kTurnUnknowns);
  const double between_degrees = degrees - verdict.scatter.degrees_of_freedom;
  const double between = std::max(0.0, rest.squaredNorm() - pure);
  verdict.turns_p = f_survival(between / between_degrees / std::pow(verdict.scatter.std_m, 2),
                               between_degrees, verdict.scatter.degrees_of_freedom);
  const TouchNoise noise{std::sqrt(rest.squaredNorm() / degrees), degrees};
  const Eigen::MatrixXd covariance = noise.std_m * noise.std_m * inverse * inverse.transpose();
  verdict.run_out = across(solution, covariance, 1);
  verdict.lobes = across(solution, covariance, 3);
  verdict.deviations_m.resize(touches.size());
  for (std::size_t i = 0; i < turned.all.size(); ++i)
    verdict.deviations_m[turned.all[i]] = rest[static_cast<Eigen::Index>(i)];
  if (problem.record) add_of_calibration(problem, touches, turned, inverse, noise, verdict);
  judge(problem.limits, verdict);
  return verdict;
}

}  // namespace calib
