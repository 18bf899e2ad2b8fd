#include "calib_core/planning/online_estimate.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <numeric>

#include "calib_core/estimation/least_squares.hpp"
#include "calib_core/kinematics/place_group.hpp"

namespace calib {
namespace {

constexpr double kSigmas = 3.0;
constexpr double kTouchNoiseMetres = 1e-4;
constexpr double kErrorShare = 1.0 / 6.0;  // of the nominal position error; per metre for an angle
constexpr double kBlockPoseShare = 1.0 / 2.0;

constexpr double kGateSigmas = 5.0;
constexpr double kReadmitSigmas = 3.0;
constexpr double kRejectedShareMax = 0.2;
/// A touch whose residual has a smaller share of its own error is not predicted by the others.
constexpr double kOwnShareMin = 1e-3;
constexpr std::size_t kRecentTouches = 8;

/// Three of these are half of the smallest clearance, kPredictedPositionErrorMinMetres.
constexpr double kAimedSphereStdMetres = kPredictedPositionErrorMinMetres / 6.0;

constexpr int kUpdatesMax = 4;
constexpr double kUpdateSmall = 1e-4;  // metres and radians; the remaining error is its square

double prior_std(const KinematicModel& nominal, int index, double nominal_position_error_m) {
  const ErrorParameter& parameter = error_parameters()[static_cast<std::size_t>(index)];
  if (group_on(nominal, index) != ParameterGroup::kBlockPose) return kErrorShare * nominal_position_error_m;
  return kBlockPoseShare * nominal_position_error_m / (parameter.is_length() ? 1.0 : kBlockPoseLeverMetres);
}

/// The knowledge of the problem with priors as wide as the nominal position error allows.
IdentificationProblem widened(const PlanningProblem& problem) {
  IdentificationProblem knowledge = problem.knowledge;
  knowledge.nominal = problem.nominal;
  knowledge.touches.clear();
  knowledge.touch_noise_m = std::hypot(kTouchNoiseMetres, problem.knowledge.touch_noise_m);
  for (std::size_t i = 0; i < kErrorParameterCount; ++i) {
    knowledge.tolerances[i] =
        std::max(prior_std(problem.nominal, static_cast<int>(i), problem.nominal_position_error_m),
                 knowledge.tolerances[i].value_or(0.0));
  }
  for (ArtefactParameter& parameter : knowledge.artefact.parameters) {
    if (parameter.std) continue;
    const bool is_angle =
        parameter.kind == ArtefactKind::kFaceTilt || parameter.kind == ArtefactKind::kPlaceTurn;
    parameter.std =
        kBlockPoseShare * problem.nominal_position_error_m / (is_angle ? kBlockPoseLeverMetres : 1.0);
  }
  return knowledge;
}

std::vector<int> columns_of(const IdentificationProblem& knowledge) {
  std::vector<int> columns(kErrorParameterCount);
  std::iota(columns.begin(), columns.end(), 0);
  for (int joint = 0; joint < kJointCount; ++joint) {
    const int position = compliance_position(joint);
    if (knowledge.nongeometric_std[static_cast<std::size_t>(position)])
      columns.push_back(nongeometric_index(position));
  }
  return columns;
}

LeastSquares fit_of(const IdentificationProblem& knowledge, const std::vector<int>& columns) {
  std::vector<std::size_t> touches(knowledge.touches.size());
  std::iota(touches.begin(), touches.end(), std::size_t{0});
  return {knowledge, {.prior = true}, columns, std::move(touches)};
}

Estimate zero_estimate(const IdentificationProblem& knowledge) {
  return {.arm = ArmVector::Zero(),
          .artefact = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(knowledge.artefact.parameters.size()))};
}

/// Covariance of the unknowns before the first touch.
Eigen::MatrixXd prior_covariance(IdentificationProblem knowledge, const std::vector<int>& columns) {
  knowledge.touches.assign(1, Touch{});  // one touch, not kept: a problem needs a row
  LeastSquares fit = fit_of(knowledge, columns);
  fit.keep({false});
  fit.linearise(zero_estimate(knowledge));
  return inverse_information(fit.information());
}

/// 3 sigma of the position of a point in the worst direction.
double position_error_bound_m(const PreparedModel& prepared, const Chain& chain,
                              const Eigen::Vector3d& point_m, int frame, const std::vector<int>& columns,
                              const Eigen::MatrixXd& covariance) {
  const auto count = static_cast<Eigen::Index>(columns.size());
  const Eigen::Matrix<double, 3, Eigen::Dynamic> slopes =
      point_arm_derivatives(prepared, chain, point_m, frame)(Eigen::all, columns);
  const Eigen::Matrix3d spread = slopes * covariance.topLeftCorner(count, count) * slopes.transpose();
  const auto eigenvalues =
      Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(spread, Eigen::EigenvaluesOnly).eigenvalues();
  return kSigmas * std::sqrt(std::max(0.0, eigenvalues[2]));
}

/// The solid behind a face that is estimated in place is as uncertain as the face, and is not moved with the
/// estimate: all touches keep the nominal position error. So do those beside a sphere or bore whose centre,
/// axis or radius is known less well than the clearances of aimed touches allow, and those at a place that
/// the touches find.
bool has_estimated_face(const PlanningProblem& problem) {
  const auto moves = [&](const ArtefactParameter& parameter) {
    return std::ranges::any_of(problem.requests, [&](const TouchRequest& request) {
      return !parameter.shifts[static_cast<std::size_t>(request.face)].center.isZero(0.0);
    });
  };
  return std::ranges::any_of(problem.knowledge.artefact.parameters, [&](const ArtefactParameter& parameter) {
    if (is_of_place(parameter)) {
      const double lever_m = parameter.kind == ArtefactKind::kPlaceTurn ? kPlaceLeverMetres : 1.0;
      return moves(parameter) && (!parameter.std || *parameter.std * lever_m > kAimedSphereStdMetres);
    }
    if (parameter.kind == ArtefactKind::kSphereCenter || parameter.kind == ArtefactKind::kBoreAxis)
      return !parameter.std || *parameter.std > kAimedSphereStdMetres;
    const bool is_radius =
        parameter.kind == ArtefactKind::kSphereRadius || parameter.kind == ArtefactKind::kBoreRadius;
    if (is_radius && parameter.std) return *parameter.std > kAimedSphereStdMetres;
    return parameter.kind == ArtefactKind::kFaceOffset && !parameter.std;
  });
}

double clamp_error_m(double error_m, double nominal_position_error_m) {
  return std::min(std::max(error_m, kPredictedPositionErrorMinMetres), nominal_position_error_m);
}

}  // namespace

OnlineArmEstimate::OnlineArmEstimate(const PlanningProblem& problem)
    : knowledge_(widened(problem)),
      columns_(columns_of(knowledge_)),
      nominal_position_error_m_(problem.nominal_position_error_m),
      estimate_(zero_estimate(knowledge_)),
      model_(problem.nominal),
      covariance_(prior_covariance(knowledge_, columns_)) {}

PredictedContact OnlineArmEstimate::add(const Touch& touch) {
  knowledge_.touches.push_back(touch);
  knowledge_.touches.back().deviation_m = 0.0;  // kTouchNoiseMetres is wider than that of a touch by hand
  kept_.push_back(true);
  LeastSquares fit = fit_of(knowledge_, columns_);
  fit.keep(kept_);
  fit.linearise(estimate_);
  const Eigen::Index last = fit.rows().rows() - 1;
  const Eigen::VectorXd row = fit.rows().row(last);
  const double std_m = fit.noise_unit_m() * std::sqrt(1.0 + row.dot(covariance_ * row));
  PredictedContact contact{
      .position_error_m = fit.residuals_m()[last],
      .predicted_position_error_m = clamp_error_m(kSigmas * std_m * inflation(), nominal_position_error_m_)};
  standardised_errors_.push_back(std::abs(contact.position_error_m) / std_m);

  const std::vector<bool> consistent = settle(fit);
  contact.contradicts = !consistent.back();
  return contact;
}

bool OnlineArmEstimate::replace(std::size_t index, const Touch& touch) {
  knowledge_.touches.at(index) = touch;
  knowledge_.touches[index].deviation_m = 0.0;  // as in add()
  kept_[index] = true;
  standardised_errors_[index] = 0.0;  // nobody predicted it: no evidence about the estimate
  LeastSquares fit = fit_of(knowledge_, columns_);
  fit.keep(kept_);
  fit.linearise(estimate_);
  return settle(fit)[index];
}

/// Returns which touches the estimate was made from; those near enough to it are taken up behind it.
std::vector<bool> OnlineArmEstimate::settle(LeastSquares& fit) {
  solve(fit);
  while (reject_worst(fit)) solve(fit);
  std::vector<bool> consistent = kept_;
  covariance_ = inverse_information(fit.information());
  readmit(fit);
  model_ = apply(knowledge_.nominal, estimate_.arm);
  return consistent;
}

void OnlineArmEstimate::solve(LeastSquares& fit) {
  for (int step = 0; step < kUpdatesMax && fit.solve(); ++step) {
    estimate_ = fit.stepped(std::move(estimate_));
    fit.linearise(estimate_);
    if (fit.step().norm() < kUpdateSmall) break;
  }
}

bool OnlineArmEstimate::reject_worst(LeastSquares& fit) {
  const auto count = static_cast<double>(kept_.size());
  const auto rejected = static_cast<double>(std::ranges::count(kept_, false));
  if (rejected + 1.0 > std::max(1.0, kRejectedShareMax * count)) return false;
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

void OnlineArmEstimate::readmit(const LeastSquares& fit) {
  for (std::size_t i = 0; i < kept_.size(); ++i) {
    if (kept_[i]) continue;
    const auto index = static_cast<Eigen::Index>(i);
    const Eigen::VectorXd row = fit.rows().row(index);
    const double std_m = fit.noise_unit_m() * std::sqrt(1.0 + row.dot(covariance_ * row));
    kept_[i] = std::abs(fit.residuals_m()[index]) < kReadmitSigmas * std_m;
  }
}

std::vector<std::size_t> OnlineArmEstimate::contradicted() const {
  std::vector<std::size_t> indices;
  for (std::size_t i = 0; i < kept_.size(); ++i) {
    if (!kept_[i]) indices.push_back(i);
  }
  return indices;
}

double OnlineArmEstimate::inflation() const {
  const std::size_t first = kept_.size() - std::min(kept_.size(), kRecentTouches);
  const auto rejected = std::count(kept_.begin() + static_cast<std::ptrdiff_t>(first), kept_.end(), false);
  double most = kSigmas;
  for (std::size_t i = first; i < standardised_errors_.size(); ++i) {
    // A single false trigger is no evidence about the arm; two are.
    if (kept_[i] || rejected > 1) most = std::max(most, standardised_errors_[i]);
  }
  return most / kSigmas;
}

double OnlineArmEstimate::predicted_position_error_m(const JointVector& joints) const {
  const PreparedModel prepared = prepare(model_);
  const Chain chain = forward_chain(prepared, joints);
  const double bound_m =
      position_error_bound_m(prepared, chain, chain.tip_in_block_m(), kFrameCount - 1, columns_, covariance_);
  return clamp_error_m(bound_m * inflation(), nominal_position_error_m_);
}

double OnlineArmEstimate::predicted_position_error_m(const PreparedModel& prepared, const Chain& chain,
                                                     const Capsule& body) const {
  const Segment axis = axis_in_block(body, chain);
  const double bound_m =
      std::max(position_error_bound_m(prepared, chain, axis.from_m, body.frame, columns_, covariance_),
               position_error_bound_m(prepared, chain, axis.to_m, body.frame, columns_, covariance_));
  return clamp_error_m(bound_m * inflation(), nominal_position_error_m_);
}

std::optional<PlanningProblem> OnlineArmEstimate::aimed_problem(const PlanningProblem& problem,
                                                                std::span<const JointVector> postures) const {
  if (has_estimated_face(problem)) return std::nullopt;
  double error_m = 0.0;
  for (const JointVector& joints : postures) error_m = std::max(error_m, predicted_position_error_m(joints));
  if (error_m >= nominal_position_error_m_) return std::nullopt;
  PlanningProblem aimed = problem;
  aimed.nominal = model_;
  aimed.nominal_position_error_m = error_m;
  aimed.standoff_min_m = kAimedStandoffMinMetres;
  const PreparedModel prepared = prepare(model_);
  std::vector<double> excess_m(aimed.scene.bodies.size(), 0.0);
  for (const JointVector& joints : postures) {
    const Chain chain = forward_chain(prepared, joints);
    for (std::size_t i = 0; i < excess_m.size(); ++i) {
      const double body_error_m = predicted_position_error_m(prepared, chain, aimed.scene.bodies[i]);
      excess_m[i] = std::max(excess_m[i], body_error_m - error_m);
    }
  }
  for (std::size_t i = 0; i < excess_m.size(); ++i) aimed.scene.bodies[i].margin_m += excess_m[i];
  return aimed;
}

double OnlineArmEstimate::face_shift_m(int face, const Eigen::Vector3d& point_m) const {
  std::vector<ContactSurface> planes;
  correct_contact_planes(knowledge_.artefact, estimate_.artefact, planes);
  const auto index = static_cast<std::size_t>(face);
  return signed_distance_m(knowledge_.artefact.contact_planes[index], point_m) -
         signed_distance_m(planes[index], point_m);
}

std::vector<double> predicted_position_errors_m(const PlanningProblem& problem,
                                                std::span<const PlannedTouch> touches) {
  if (has_estimated_face(problem))
    return std::vector<double>(touches.size(), problem.nominal_position_error_m);
  IdentificationProblem knowledge = widened(problem);
  const std::vector<int> columns = columns_of(knowledge);
  for (const PlannedTouch& touch : touches)
    knowledge.touches.push_back({.face = touch.face, .joints = touch.joints});
  Eigen::MatrixXd covariance = prior_covariance(knowledge, columns);
  if (touches.empty()) return {};
  LeastSquares fit = fit_of(knowledge, columns);
  fit.linearise(zero_estimate(knowledge));

  const PreparedModel prepared = prepare(problem.nominal);
  std::vector<double> errors_m;
  for (std::size_t i = 0; i < touches.size(); ++i) {
    const Chain chain = forward_chain(prepared, touches[i].joints);
    errors_m.push_back(clamp_error_m(
        position_error_bound_m(prepared, chain, chain.tip_in_block_m(), kFrameCount - 1, columns, covariance),
        problem.nominal_position_error_m));
    const Eigen::VectorXd row = fit.rows().row(static_cast<Eigen::Index>(i));
    const Eigen::VectorXd moved = covariance * row;
    covariance -= moved * moved.transpose() / (1.0 + row.dot(moved));
  }
  return errors_m;
}

}  // namespace calib
