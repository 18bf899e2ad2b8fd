#include "calib_core/planning/online_estimate.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <numeric>

#include "calib_core/geometry/units.hpp"
#include "calib_core/kinematics/inverse_kinematics.hpp"
#include "calib_core/motion/swept_collision.hpp"
#include "calib_core/planning/touch_feasibility.hpp"

namespace calib {
namespace {

constexpr double kSigmas = 3.0;
constexpr double kTouchNoiseMetres = 1e-4;
constexpr double kErrorShare = 1.0 / 6.0;  // of the nominal miss; per metre for an angle
constexpr double kPlaceShare = 1.0 / 2.0;

constexpr double kGateSigmas = 5.0;
constexpr double kTakeBackSigmas = 3.0;
constexpr double kDroppedShareMax = 0.2;
/// What the others do not tell of a touch at all cannot contradict them.
constexpr double kOwnShareMin = 1e-3;
constexpr std::size_t kRecentTouches = 8;

constexpr int kStepsMax = 4;
constexpr double kStepSmall = 1e-4;  // metres and radians: what is left is its square

double believable_std(const ErrorParameter& parameter, double nominal_miss_m) {
  if (parameter.group() != ParameterGroup::kPlace) return kErrorShare * nominal_miss_m;
  return kPlaceShare * nominal_miss_m / (parameter.is_length() ? 1.0 : kPlaceLeverMetres);
}

/// The problem's knowledge with errors as large as the nominal miss says.
IdentificationProblem widened(const PlanningProblem& problem) {
  IdentificationProblem knowledge = problem.knowledge;
  knowledge.nominal = problem.nominal;
  knowledge.touches.clear();
  knowledge.touch_noise_m = std::hypot(kTouchNoiseMetres, problem.knowledge.touch_noise_m);
  for (std::size_t i = 0; i < kErrorParameterCount; ++i) {
    knowledge.tolerances[i] = std::max(believable_std(error_parameters()[i], problem.nominal_miss_m),
                                       knowledge.tolerances[i].value_or(0.0));
  }
  for (ArtefactParameter& parameter : knowledge.artefact.parameters) {
    if (parameter.std) continue;
    const bool turns = parameter.kind == ArtefactKind::kFaceTilt;
    parameter.std = kPlaceShare * problem.nominal_miss_m / (turns ? kPlaceLeverMetres : 1.0);
  }
  return knowledge;
}

std::vector<int> columns_of(const IdentificationProblem& knowledge) {
  std::vector<int> columns(kErrorParameterCount);
  std::iota(columns.begin(), columns.end(), 0);
  for (int i = 0; i < kComplianceCount; ++i) {
    if (knowledge.std_compliance_rad_per_nm[static_cast<std::size_t>(i)])
      columns.push_back(kErrorParameterCount + i);
  }
  return columns;
}

LeastSquares fit_of(const IdentificationProblem& knowledge, const std::vector<int>& columns) {
  std::vector<std::size_t> touches(knowledge.touches.size());
  std::iota(touches.begin(), touches.end(), std::size_t{0});
  return {knowledge, {.prior = true}, columns, std::move(touches)};
}

Estimate nothing_wrong(const IdentificationProblem& knowledge) {
  return {.arm = ArmVector::Zero(),
          .artefact = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(knowledge.artefact.parameters.size()))};
}

/// Covariance of the unknowns before the first touch.
Eigen::MatrixXd prior_covariance(IdentificationProblem knowledge, const std::vector<int>& columns) {
  knowledge.touches.assign(1, Touch{});  // a problem without rows has no size; this one has no say
  LeastSquares fit = fit_of(knowledge, columns);
  fit.keep({false});
  fit.linearise(nothing_wrong(knowledge));
  return covariance_of(fit.information());
}

/// 3 sigma of a point in the worst direction.
double worst_spread_m(const PreparedModel& prepared, const Chain& chain, const Eigen::Vector3d& point_m,
                      int frame, const std::vector<int>& columns, const Eigen::MatrixXd& covariance) {
  const auto count = static_cast<Eigen::Index>(columns.size());
  const Eigen::Matrix<double, 3, Eigen::Dynamic> slopes =
      point_arm_derivatives(prepared, chain, point_m, frame)(Eigen::all, columns);
  const Eigen::Matrix3d spread = slopes * covariance.topLeftCorner(count, count) * slopes.transpose();
  const auto eigenvalues =
      Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(spread, Eigen::EigenvaluesOnly).eigenvalues();
  return kSigmas * std::sqrt(std::max(0.0, eigenvalues[2]));
}

/// A face whose place is not known leaves the solid around it as uncertain as itself: as long as nothing here
/// moves that with the estimate, everything keeps the nominal miss.
bool has_estimated_face(const PlanningProblem& problem) {
  return std::ranges::any_of(problem.knowledge.artefact.parameters, [](const ArtefactParameter& parameter) {
    return parameter.kind == ArtefactKind::kFaceOffset && !parameter.std;
  });
}

double within_bounds_m(double miss_m, double nominal_miss_m) {
  return std::min(std::max(miss_m, kPredictedMissMinMetres), nominal_miss_m);
}

/// The planned touch in its pose, as a problem's model and miss make it.
std::variant<AimedTouch, std::string> remade(PlanningProblem problem, const TouchPose& pose,
                                             const PlannedTouch& planned) {
  const auto joints = solve_near(problem.nominal, pose.block_from_tip, planned.joints);
  if (!joints) return "out of reach";
  auto made = make_touch(problem, find_touched(problem, planned.face), pose, *joints);
  if (auto* trouble = std::get_if<std::string>(&made)) return std::move(*trouble);
  PlannedTouch& touch = std::get<PlannedTouch>(made);
  touch.role = planned.role;
  return AimedTouch{std::move(touch), std::move(problem)};
}

TouchPose pose_of(const PlanningProblem& problem, const PlannedTouch& planned) {
  return {forward_kinematics(problem.nominal, planned.joints), planned.tilt_rad};
}

bool is_clear(const PlanningProblem& problem, const CollisionScene& scene, const JointVector& joints,
              double clearance_m) {
  return !find_clash(scene, forward_chain(problem.nominal, joints), clearance_m);
}

/// Where a transfer that begins or ends there can begin or end: the posture itself when it is clear, else the
/// nearest one along the normal that is, when the way there comes no nearer than the posture itself.
std::optional<JointVector> lifted(const PlanningProblem& problem, const TransferEnd& end) {
  const CollisionScene scene = travel_scene(problem);
  if (is_clear(problem, scene, end.joints, problem.nominal_miss_m)) return end.joints;
  if (!end.outward) return std::nullopt;
  // No slow zone here: the arm is in it, or goes into it.
  double kept_m = problem.nominal_miss_m;
  while (kept_m > 0.0 && !is_clear(problem, problem.scene, end.joints, kept_m))
    kept_m -= kSweptErrorMaxMetres;
  const Eigen::Isometry3d here = forward_kinematics(problem.nominal, end.joints);
  constexpr int kLiftsMax = 20;
  constexpr double kLiftMetres = 0.004;
  JointVector joints = end.joints;
  for (int lift = 1; lift <= kLiftsMax; ++lift) {
    Eigen::Isometry3d higher = here;
    higher.pretranslate(lift * kLiftMetres * *end.outward);
    const auto next = solve_near(problem.nominal, higher, joints);
    if (!next || !problem.joint_ranges.contains(*next)) return std::nullopt;
    joints = *next;
    if (find_clash_on_way(problem.scene, problem.nominal, end.joints, joints,
                          std::max(0.0, kept_m - kSweptErrorMaxMetres))) {
      return std::nullopt;
    }
    if (is_clear(problem, scene, joints, problem.nominal_miss_m)) return joints;
  }
  return std::nullopt;
}

std::optional<std::vector<JointVector>> find_lifted_transfer(const PlanningProblem& problem,
                                                             const TransferEnd& from, const TransferEnd& to) {
  const auto begin = lifted(problem, from);
  if (!begin) return std::nullopt;
  const auto end = lifted(problem, to);
  if (!end) return std::nullopt;
  auto way = find_transfer(problem, *begin, *end);
  if (!way) return std::nullopt;
  if (*begin != from.joints) way->insert(way->begin(), *begin);
  if (*end != to.joints) way->push_back(*end);
  if (way->size() > kAimedTransferPosturesMax) return std::nullopt;
  return way;
}

/// Postures all along a way, ends included.
std::vector<JointVector> looked_at(const JointVector& from, const std::vector<JointVector>& via,
                                   const JointVector& to) {
  constexpr double kStepRad = 10.0 * kRadiansPerDegree;
  const std::vector<JointVector> stops = whole_way(from, via, to);
  std::vector<JointVector> postures{from};
  for (std::size_t leg = 1; leg < stops.size(); ++leg) {
    const JointVector move = stops[leg] - stops[leg - 1];
    const int steps = static_cast<int>(std::ceil(move.cwiseAbs().maxCoeff() / kStepRad));
    for (int step = 1; step <= steps; ++step) postures.push_back(stops[leg - 1] + move * step / steps);
  }
  return postures;
}

/// Out and in on ways that were clear when the ends were made.
std::optional<std::vector<JointVector>> through_park(const PlanningProblem& problem, const TransferEnd& from,
                                                     const TransferEnd& to) {
  auto way = find_transfer(from.made_with ? *from.made_with : problem, from.joints, problem.park_joints);
  const auto in = find_transfer(to.made_with ? *to.made_with : problem, problem.park_joints, to.joints);
  if (!way || !in || way->size() + 1 + in->size() > kAimedTransferPosturesMax) return std::nullopt;
  way->push_back(problem.park_joints);
  way->insert(way->end(), in->begin(), in->end());
  return way;
}

}  // namespace

Aim::Aim(const PlanningProblem& problem)
    : knowledge_(widened(problem)),
      columns_(columns_of(knowledge_)),
      nominal_miss_m_(problem.nominal_miss_m),
      estimate_(nothing_wrong(knowledge_)),
      model_(problem.nominal),
      covariance_(prior_covariance(knowledge_, columns_)) {}

AimedContact Aim::add(const Touch& touch) {
  knowledge_.touches.push_back(touch);
  kept_.push_back(true);
  LeastSquares fit = fit_of(knowledge_, columns_);
  fit.keep(kept_);
  fit.linearise(estimate_);
  const Eigen::Index last = fit.rows().rows() - 1;
  const Eigen::VectorXd row = fit.rows().row(last);
  const double std_m = fit.noise_unit_m() * std::sqrt(1.0 + row.dot(covariance_ * row));
  AimedContact contact{.miss_m = fit.residuals_m()[last],
                       .predicted_miss_m = within_bounds_m(kSigmas * std_m * inflation(), nominal_miss_m_)};
  surprises_.push_back(std::abs(contact.miss_m) / std_m);

  solve(fit);
  while (drop_one(fit)) solve(fit);
  contact.contradicts = !kept_.back();
  covariance_ = covariance_of(fit.information());
  take_back(fit);
  model_ = apply(knowledge_.nominal, estimate_.arm);
  return contact;
}

void Aim::solve(LeastSquares& fit) {
  for (int step = 0; step < kStepsMax && fit.solve(); ++step) {
    estimate_ = fit.stepped(std::move(estimate_));
    fit.linearise(estimate_);
    if (fit.step().norm() < kStepSmall) break;
  }
}

bool Aim::drop_one(LeastSquares& fit) {
  const auto count = static_cast<double>(kept_.size());
  const auto dropped = static_cast<double>(std::ranges::count(kept_, false));
  if (dropped + 1.0 > std::max(1.0, kDroppedShareMax * count)) return false;
  const Eigen::VectorXd& leverages = fit.leverages();
  double most = kGateSigmas;
  std::optional<std::size_t> worst;
  for (std::size_t i = 0; i < kept_.size(); ++i) {
    const auto row = static_cast<Eigen::Index>(i);
    const double own_share = 1.0 - leverages[row];
    if (!kept_[i] || own_share < kOwnShareMin) continue;
    const double off = std::abs(fit.residuals_m()[row]) / (fit.noise_unit_m() * std::sqrt(own_share));
    if (off <= most) continue;
    most = off;
    worst = i;
  }
  if (!worst) return false;
  kept_[*worst] = false;
  fit.keep(kept_);
  fit.linearise(estimate_);
  return true;
}

void Aim::take_back(const LeastSquares& fit) {
  for (std::size_t i = 0; i < kept_.size(); ++i) {
    if (kept_[i]) continue;
    const auto index = static_cast<Eigen::Index>(i);
    const Eigen::VectorXd row = fit.rows().row(index);
    const double std_m = fit.noise_unit_m() * std::sqrt(1.0 + row.dot(covariance_ * row));
    kept_[i] = std::abs(fit.residuals_m()[index]) < kTakeBackSigmas * std_m;
  }
}

double Aim::inflation() const {
  const std::size_t first = kept_.size() - std::min(kept_.size(), kRecentTouches);
  const auto dropped = std::count(kept_.begin() + static_cast<std::ptrdiff_t>(first), kept_.end(), false);
  double most = kSigmas;
  for (std::size_t i = first; i < surprises_.size(); ++i) {
    // One wrong trigger says nothing of the arm; two of them do.
    if (kept_[i] || dropped > 1) most = std::max(most, surprises_[i]);
  }
  return most / kSigmas;
}

double Aim::predicted_miss_m(const JointVector& joints) const {
  const PreparedModel prepared = prepare(model_);
  const Chain chain = forward_chain(prepared, joints);
  const double spread_m =
      worst_spread_m(prepared, chain, chain.tip_in_block_m(), kFrameCount - 1, columns_, covariance_);
  return within_bounds_m(spread_m * inflation(), nominal_miss_m_);
}

double Aim::predicted_miss_m(const PreparedModel& prepared, const Chain& chain, const Capsule& body) const {
  const Segment placed = place(body, chain);
  const double spread_m =
      std::max(worst_spread_m(prepared, chain, placed.from_m, body.frame, columns_, covariance_),
               worst_spread_m(prepared, chain, placed.to_m, body.frame, columns_, covariance_));
  return within_bounds_m(spread_m * inflation(), nominal_miss_m_);
}

std::optional<PlanningProblem> Aim::aimed_problem(const PlanningProblem& problem,
                                                  std::span<const JointVector> postures) const {
  if (has_estimated_face(problem)) return std::nullopt;
  double miss_m = 0.0;
  for (const JointVector& joints : postures) miss_m = std::max(miss_m, predicted_miss_m(joints));
  if (miss_m >= nominal_miss_m_) return std::nullopt;
  PlanningProblem aimed = problem;
  aimed.nominal = model_;
  aimed.nominal_miss_m = miss_m;
  aimed.standoff_min_m = kAimedStandoffMinMetres;
  const PreparedModel prepared = prepare(model_);
  std::vector<double> farther_m(aimed.scene.bodies.size(), 0.0);
  for (const JointVector& joints : postures) {
    const Chain chain = forward_chain(prepared, joints);
    for (std::size_t i = 0; i < farther_m.size(); ++i) {
      const double body_miss_m = predicted_miss_m(prepared, chain, aimed.scene.bodies[i]);
      farther_m[i] = std::max(farther_m[i], body_miss_m - miss_m);
    }
  }
  for (std::size_t i = 0; i < farther_m.size(); ++i) aimed.scene.bodies[i].margin_m += farther_m[i];
  return aimed;
}

double Aim::face_shift_m(int face, const Eigen::Vector3d& point_m) const {
  std::vector<Plane> planes;
  place_planes(knowledge_.artefact, estimate_.artefact, planes);
  const auto index = static_cast<std::size_t>(face);
  return signed_distance_m(knowledge_.artefact.contact_planes[index], point_m) -
         signed_distance_m(planes[index], point_m);
}

std::variant<AimedTouch, std::string> nominal_touch(const PlanningProblem& problem,
                                                    const PlannedTouch& planned) {
  return remade(problem, pose_of(problem, planned), planned);
}

std::variant<AimedTouch, std::string> aim_touch(const PlanningProblem& problem, const Aim& aim,
                                                const PlannedTouch& planned) {
  auto aimed = aim.aimed_problem(problem, std::span(&planned.joints, 1));
  if (!aimed) return nominal_touch(problem, planned);
  TouchPose pose = pose_of(problem, planned);
  const Plane& plane = problem.faces[static_cast<std::size_t>(planned.face)].plane;
  const Eigen::Vector3d shift_m =
      aim.face_shift_m(planned.face, pose.block_from_tip.translation()) * plane.outward;
  pose.block_from_tip.pretranslate(shift_m);
  return remade(std::move(*aimed), pose, planned);
}

TransferEnd end_of(const AimedTouch& touch) {
  return {touch.touch.clear_joints, -touch.touch.search_direction, &touch.problem};
}

std::optional<std::vector<JointVector>> find_aimed_transfer(const PlanningProblem& problem, const Aim& aim,
                                                            const TransferEnd& from, const TransferEnd& to) {
  std::vector<JointVector> postures{from.joints, to.joints};
  constexpr int kTriesMax = 3;
  for (int attempt = 0; attempt < kTriesMax; ++attempt) {
    const auto aimed = aim.aimed_problem(problem, postures);
    const double miss_m = aimed ? aimed->nominal_miss_m : problem.nominal_miss_m;
    auto way = find_lifted_transfer(aimed ? *aimed : problem, from, to);
    if (!way) break;
    const std::size_t known = postures.size();
    for (const JointVector& joints : looked_at(from.joints, *way, to.joints)) {
      if (aim.predicted_miss_m(joints) > miss_m) postures.push_back(joints);
    }
    if (postures.size() == known) return way;
  }
  return through_park(problem, from, to);
}

std::vector<double> predicted_misses_m(const PlanningProblem& problem,
                                       std::span<const PlannedTouch> touches) {
  if (has_estimated_face(problem)) return std::vector<double>(touches.size(), problem.nominal_miss_m);
  IdentificationProblem knowledge = widened(problem);
  const std::vector<int> columns = columns_of(knowledge);
  for (const PlannedTouch& touch : touches)
    knowledge.touches.push_back({.face = touch.face, .joints = touch.joints});
  Eigen::MatrixXd covariance = prior_covariance(knowledge, columns);
  if (touches.empty()) return {};
  LeastSquares fit = fit_of(knowledge, columns);
  fit.linearise(nothing_wrong(knowledge));

  const PreparedModel prepared = prepare(problem.nominal);
  std::vector<double> misses_m;
  for (std::size_t i = 0; i < touches.size(); ++i) {
    const Chain chain = forward_chain(prepared, touches[i].joints);
    misses_m.push_back(within_bounds_m(
        worst_spread_m(prepared, chain, chain.tip_in_block_m(), kFrameCount - 1, columns, covariance),
        problem.nominal_miss_m));
    const Eigen::VectorXd row = fit.rows().row(static_cast<Eigen::Index>(i));
    const Eigen::VectorXd moved = covariance * row;
    covariance -= moved * moved.transpose() / (1.0 + row.dot(moved));
  }
  return misses_m;
}

}  // namespace calib
