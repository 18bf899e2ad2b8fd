#include "calib_core/planning/internal/optimal_design.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <sstream>
#include <stdexcept>
#include <utility>
#include <vector>

#include "calib_core/estimation/column_choice.hpp"
#include "calib_core/estimation/least_squares.hpp"
#include "calib_core/geometry/units.hpp"
#include "calib_core/planning/internal/condition_number_exchange.hpp"
#include "calib_core/planning/internal/fedorov_exchange.hpp"
#include "calib_core/planning/internal/held_out_selection.hpp"
#include "calib_core/uncertainty/tip_uncertainty.hpp"
#include "calib_core/uncertainty/uncertainty_propagation.hpp"

namespace calib {
namespace {

constexpr int kExchangeRoundsMax = 20;
constexpr double kImprovementMin = 3e-5;

/// Prior information on every unknown as a fraction of the mean information of one touch: makes the matrix
/// invertible, negligible against the touches.
constexpr double kRidge = 1e-8;

/// Smallest eigenvalue of an information matrix of unit diagonal whose unknowns are determined. Rounding
/// leaves some 1e-15 of a zero; the plans of the shipped cells have 1e-4 and more.
constexpr double kDeterminedMin = 1e-12;

/// The variance of a sphere's centre, a bore's axis, a further ball of the stylus or a place of the artefact
/// that is found by the touches, beside that of the tip: enough to have it touched from all sides. The tip
/// alone would ask for one point of it in many postures.
constexpr double kFreePlaceShare = 0.1;

/// The identification from given touches, linearised at the nominal arm.
class ExpectedIdentification {
 public:
  explicit ExpectedIdentification(const PlanningProblem& problem)
      : problem_(problem.knowledge), options_(problem.identification) {
    identifiable_ =
        problem.knowledge.columns
            ? IdentifiableSet{.columns = *problem.knowledge.columns}
            : attainable_set(problem.knowledge.nominal, problem.knowledge.artefact, options_.identifiability);
    estimated_ = estimated_columns(problem_, options_, identifiable_);
    problem_.nominal = problem.nominal;
    nominal_.artefact = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(problem_.artefact.parameters.size()));
  }

  [[nodiscard]] const std::vector<int>& identifiable() const { return identifiable_.columns; }
  [[nodiscard]] const std::vector<int>& estimated() const { return estimated_; }
  [[nodiscard]] Eigen::Index unknown_count() const {
    return std::ssize(estimated_) + nominal_.artefact.size();
  }
  /// Weights of what the touches find in place, by their positions among all unknowns.
  [[nodiscard]] std::vector<std::pair<Eigen::Index, double>> free_places() const {
    std::vector<std::pair<Eigen::Index, double>> weights;
    const auto& parameters = problem_.artefact.parameters;
    for (std::size_t k = 0; k < parameters.size(); ++k) {
      const ArtefactParameter& parameter = parameters[k];
      const bool is_of_tip = parameter.kind == ArtefactKind::kTipCenter;
      if (!is_of_tip && !is_free_round_place(parameter) && (!is_of_place(parameter) || parameter.std))
        continue;
      const double lever_m = parameter.kind == ArtefactKind::kPlaceTurn ? kPlaceLeverMetres : 1.0;
      weights.emplace_back(std::ssize(estimated_) + static_cast<Eigen::Index>(k),
                           kFreePlaceShare * lever_m * lever_m);
    }
    return weights;
  }
  /// Positions of the identifiable columns among the estimated ones.
  [[nodiscard]] std::vector<Eigen::Index> positions() const {
    std::vector<Eigen::Index> positions;
    for (const int column : identifiable_.columns) {
      positions.push_back(std::ranges::find(estimated_, column) - estimated_.begin());
    }
    return positions;
  }

  /// One row per touch, divided by the noise. Computed one by one and not in lanes: postures that are turned
  /// about the stylus have equal rows, and which of them is chosen must not depend on how a processor rounds.
  Eigen::MatrixXd rows(std::vector<Touch> touches) {
    const LeastSquares fit = linearised(std::move(touches));
    const PreparedModel arm = prepare(problem_.nominal);
    Eigen::MatrixXd rows(fit.rows().rows(), fit.rows().cols());
    for (Eigen::Index row = 0; row < rows.rows(); ++row) {
      const Touch& touch = problem_.touches[static_cast<std::size_t>(row)];
      const auto face = static_cast<std::size_t>(touch.face);
      const Chain chain = forward_chain(arm, touch.joints);
      const BallContact contact =
          contact_at(problem_.artefact.contact_planes[face], chain.block_from_frame.back());
      const ArmRow slopes = distance_derivatives(arm, chain, contact.ball_m, contact.normal);
      Eigen::Index column = 0;
      for (const int arm_column : estimated_) rows(row, column++) = fit.weights()[row] * slopes[arm_column];
      for (const ArtefactParameter& parameter : problem_.artefact.parameters) {
        rows(row, column++) = fit.weights()[row] * parameter.shifts[face].at(contact);
      }
    }
    return rows;
  }
  /// Information of priors and certified lengths.
  Eigen::MatrixXd prior() { return linearised({}).information(); }

  /// Whether these touches determine all unknowns: by more than kDeterminedMin. A decomposition that merely
  /// ends would say for touches that do not how a compiler happened to round.
  bool is_determined_by(std::vector<Touch> touches) {
    LeastSquares fit = linearised(std::move(touches));
    if (!fit.solve()) return false;
    const Eigen::MatrixXd& information = fit.information();
    const Eigen::VectorXd scale = information.diagonal().cwiseSqrt().cwiseInverse();
    const Eigen::MatrixXd scaled = scale.asDiagonal() * information * scale.asDiagonal();
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(scaled, Eigen::EigenvaluesOnly);
    return solver.info() == Eigen::Success && solver.eigenvalues()[0] > kDeterminedMin;
  }

  ExpectedFigures figures(std::vector<Touch> touches) {
    LeastSquares fit = linearised(std::move(touches));
    if (!fit.solve())
      throw std::invalid_argument("the touches do not determine all parameters that are to be identified");
    const FullLinearisation whole = linearise_all_parameters(problem_, options_, fit, nominal_);
    return {propagate_uncertainty(problem_, options_, identifiable_, fit, whole,
                                  {problem_.touch_noise_m, std::numeric_limits<double>::infinity()}),
            fit.condition_numbers(positions()).as_is};
  }

 private:
  LeastSquares linearised(std::vector<Touch> touches) {
    problem_.touches = std::move(touches);
    std::vector<std::size_t> all(problem_.touches.size());
    std::iota(all.begin(), all.end(), 0u);
    LeastSquares fit(problem_, options_, estimated_, std::move(all));
    fit.linearise(nominal_);
    return fit;
  }

  IdentificationProblem problem_;
  IdentificationOptions options_;
  IdentifiableSet identifiable_;
  std::vector<int> estimated_;
  Estimate nominal_;
};

/// Chooses the fitted touches by the criterion of the goal.
class TouchChooser {
 public:
  TouchChooser(const PlanningProblem& problem, std::span<const TouchCandidate> candidates,
               ExpectedIdentification& expected)
      : problem_(problem),
        candidates_(candidates),
        expected_(expected),
        region_(region_of(problem)),
        exchange_(exchange_of(problem, candidates, expected)) {
    if (by_tip()) exchange_.set_weight(tip_weight());
  }

  void restart(const std::vector<std::size_t>& chosen) { exchange_.restart(chosen); }

  void settle(int count) {
    if (static_cast<int>(exchange_.chosen().size()) > count) {
      exchange_.shrink(count);
    } else {
      exchange_.grow(count);
    }
    for (int round = 0; round < kExchangeRoundsMax && exchange_.improve(kImprovementMin); ++round) {
    }
    if (problem_.goal.criterion == PlanCriterion::kConditionNumber) reduce_condition_number(exchange_);
  }

  [[nodiscard]] const std::vector<std::size_t>& chosen() const { return exchange_.chosen(); }

  /// Nothing when the region holds no posture.
  [[nodiscard]] std::optional<double> tip_rms_m() const {
    return region_.rms_m(expected_.figures(touches()).uncertainty.covariance());
  }

  /// Whether the chosen touches determine all parameters to be identified.
  [[nodiscard]] bool is_determined() const { return expected_.is_determined_by(touches()); }

  /// Whether the goal needs a tip error but the region has no posture.
  [[nodiscard]] bool is_region_missing() const {
    return region_.posture_count == 0 && (by_tip() || problem_.goal.tip_rms_max_m);
  }

  /// The failure that reports the accuracy of the chosen touches.
  [[nodiscard]] ChoiceFailure insufficient_accuracy() const {
    const UncertaintyBudget uncertainty = expected_.figures(touches()).uncertainty;
    const auto rms_m = [&](const UncertaintySource& source) { return *region_.rms_m(source.covariance); };
    const UncertaintySource& most = *std::ranges::max_element(uncertainty.sources, {}, rms_m);
    const double best_m = *region_.rms_m(uncertainty.covariance());
    std::ostringstream reason;
    reason.precision(3);
    reason << chosen().size() << " touches leave " << mm_from_metres(best_m) << " mm rms "
           << (problem_.goal.criterion == PlanCriterion::kTipInJointRanges ? "over the joint ranges"
                                                                           : "in the workspace box")
           << ", most of it from " << most.name << " (" << mm_from_metres(rms_m(most)) << " mm)";
    return {.best_tip_rms_m = best_m, .reason = reason.str()};
  }

 private:
  [[nodiscard]] bool by_tip() const {
    return problem_.goal.criterion == PlanCriterion::kTipInBox ||
           problem_.goal.criterion == PlanCriterion::kTipInJointRanges;
  }

  [[nodiscard]] std::vector<Touch> touches() const {
    std::vector<Touch> touches;
    for (const std::size_t i : chosen()) touches.push_back(touch_of(candidates_[i]));
    return touches;
  }

  static Touch touch_of(const TouchCandidate& candidate) {
    return {.face = candidate.face, .joints = candidate.joints};
  }

  static TipRegion region_of(const PlanningProblem& problem) {
    const KinematicModel& arm = problem.knowledge.nominal;
    return problem.goal.criterion == PlanCriterion::kTipInJointRanges
               ? region_over_joint_ranges(arm, problem.joint_ranges)
               : region_over_box(arm, problem.joint_ranges, problem.workspace_box);
  }

  /// Weight of the unknowns for the mean square tip error; of the artefact only what is found in place.
  [[nodiscard]] Eigen::MatrixXd tip_weight() const {
    const std::vector<int>& columns = expected_.estimated();
    Eigen::MatrixXd weight = Eigen::MatrixXd::Zero(expected_.unknown_count(), expected_.unknown_count());
    const auto count = std::ssize(columns);
    weight.topLeftCorner(count, count) = region_.mean_square(columns, columns);
    for (const auto& [position, share] : expected_.free_places()) weight(position, position) = share;
    return weight;
  }

  /// For the tip error with all unknowns, else with the identifiable errors of the arm only.
  FedorovExchange exchange_of(const PlanningProblem& problem, std::span<const TouchCandidate> candidates,
                              ExpectedIdentification& expected) const {
    std::vector<Touch> touches;
    std::vector<int> faces;
    for (const TouchCandidate& candidate : candidates) {
      touches.push_back(touch_of(candidate));
      faces.push_back(candidate.face);
    }
    std::vector<GroupBounds> bounds;
    for (const TouchRequest& request : problem.requests) {
      const auto available = static_cast<int>(std::ranges::count(faces, request.face));
      if (available < request.fit_min + request.held_out_count) {
        throw std::logic_error("fewer touches can be made on a face than are wanted there");
      }
      bounds.push_back(
          {request.face, request.fit_min, std::min(request.fit_max, available - request.held_out_count)});
    }
    Eigen::MatrixXd rows = expected.rows(std::move(touches));
    Eigen::MatrixXd prior = expected.prior();
    if (!by_tip()) {
      const std::vector<Eigen::Index> positions = expected.positions();
      rows = rows(Eigen::all, positions).eval();
      prior = Eigen::MatrixXd::Zero(std::ssize(positions), std::ssize(positions));
    }
    prior.diagonal() += kRidge / static_cast<double>(rows.rows()) * rows.colwise().squaredNorm().transpose();
    return FedorovExchange(rows, faces, std::move(bounds), std::move(prior));
  }

  const PlanningProblem& problem_;
  std::span<const TouchCandidate> candidates_;
  ExpectedIdentification& expected_;
  TipRegion region_;
  FedorovExchange exchange_;
};

/// Reduces the choice of goal.fit_count touches to the fewest that reach the wanted accuracy (bisection).
std::optional<ChoiceFailure> settle_fewest(const PlanningProblem& problem, TouchChooser& chooser, int least) {
  const double wanted_m = *problem.goal.tip_rms_max_m;
  const auto reaches = [&](int count) {
    chooser.settle(count);
    return chooser.is_determined() && chooser.tip_rms_m().value() <= wanted_m;
  };
  if (chooser.tip_rms_m().value() > wanted_m) return chooser.insufficient_accuracy();
  std::vector<std::size_t> enough = chooser.chosen();
  int too_few = least - 1;
  while (std::ssize(enough) - too_few > 1) {
    const auto count = static_cast<int>((std::ssize(enough) + too_few) / 2);
    chooser.restart(enough);
    if (reaches(count)) {
      enough = chooser.chosen();
    } else {
      too_few = count;
    }
  }
  chooser.restart(enough);
  return std::nullopt;
}

/// Features that measure the similarity of touches on a face: position on the face in quarters of its
/// extents, direction of the stylus, and joints 1 to 3 in radians. The rotation about the stylus has no
/// effect.
Eigen::MatrixXd touch_features(const PlanningProblem& problem, std::span<const TouchCandidate> candidates) {
  Eigen::MatrixXd features(8, std::ssize(candidates));
  for (std::size_t i = 0; i < candidates.size(); ++i) {
    const TouchCandidate& candidate = candidates[i];
    const Face& face = problem.faces[static_cast<std::size_t>(candidate.face)];
    const Eigen::Vector3d from_center_m = candidate.pose.block_from_tip.translation() - face.center_m;
    const Eigen::Vector2d quarter_m = 0.5 * face.half_extent_m;
    features.col(static_cast<Eigen::Index>(i)) << from_center_m.dot(face.edge_u) / quarter_m.x(),
        from_center_m.dot(face.edge_v()) / quarter_m.y(), candidate.pose.block_from_tip.linear().col(2),
        candidate.joints.head<3>();
  }
  return features;
}

std::vector<std::size_t> held_out(const PlanningProblem& problem, std::span<const TouchCandidate> candidates,
                                  const std::vector<std::size_t>& fit) {
  std::vector<int> faces;
  for (const TouchCandidate& candidate : candidates) faces.push_back(candidate.face);
  std::vector<Quota> quotas;
  for (const TouchRequest& request : problem.requests) {
    quotas.push_back({request.face, request.held_out_count});
  }
  return farthest_point_sampling(touch_features(problem, candidates), faces, quotas, fit);
}

/// Lower limit: the minimum of every face, and one touch per identifiable parameter.
int count_min(const PlanningProblem& problem, const ExpectedIdentification& expected) {
  int count = 0;
  for (const TouchRequest& request : problem.requests) count += request.fit_min;
  return std::max(count, static_cast<int>(expected.identifiable().size()));
}

}  // namespace

std::variant<TouchChoice, ChoiceFailure> choose_touches(const PlanningProblem& problem,
                                                        std::span<const TouchCandidate> candidates,
                                                        const std::function<void(double)>& progress) {
  ExpectedIdentification expected(problem);
  TouchChooser chooser(problem, candidates, expected);
  if (chooser.is_region_missing()) {
    return ChoiceFailure{
        .reason = "no posture within the joint ranges has the tip in the region of the wanted accuracy"};
  }
  if (progress) progress(0.2);
  chooser.settle(problem.goal.fit_count);
  if (!chooser.is_determined()) {
    return ChoiceFailure{.kind = ChoiceFailure::Kind::kUnidentifiable,
                         .reason = "the touches do not determine all parameters that are to be identified"};
  }
  if (problem.goal.tip_rms_max_m) {
    if (auto failure = settle_fewest(problem, chooser, count_min(problem, expected))) return *failure;
  }
  if (progress) progress(0.9);
  TouchChoice choice{.fit = chooser.chosen(), .held_out = {}, .tip_rms_m = chooser.tip_rms_m()};
  choice.held_out = held_out(problem, candidates, choice.fit);
  return choice;
}

ExpectedFigures expected_figures(const PlanningProblem& problem, std::span<const Touch> touches) {
  return ExpectedIdentification(problem).figures({touches.begin(), touches.end()});
}

}  // namespace calib
