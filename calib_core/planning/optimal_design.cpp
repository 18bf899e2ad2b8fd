#include "calib_core/planning/internal/optimal_design.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <sstream>
#include <stdexcept>

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

constexpr int kRoundsMax = 20;
constexpr double kWorthIt = 3e-5;

/// What is known of an unknown before any touch, where nothing is: this share of what one touch tells of it
/// on average. Enough for an inverse, nothing beside the touches.
constexpr double kRidge = 1e-8;

/// The problem of identifying from these touches with the arm that aims, linearised there.
class Expectation {
 public:
  explicit Expectation(const PlanningProblem& problem)
      : problem_(problem.knowledge), options_(problem.identification) {
    identifiable_ =
        problem.knowledge.columns
            ? IdentifiableSet{.columns = *problem.knowledge.columns}
            : attainable_set(problem.knowledge.nominal, problem.knowledge.artefact, options_.identifiability);
    estimated_ = estimated_columns(options_, identifiable_);
    problem_.nominal = problem.nominal;
    nominal_.artefact = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(problem_.artefact.parameters.size()));
  }

  [[nodiscard]] const std::vector<int>& identifiable() const { return identifiable_.columns; }
  [[nodiscard]] const std::vector<int>& estimated() const { return estimated_; }
  [[nodiscard]] Eigen::Index unknown_count() const {
    return std::ssize(estimated_) + nominal_.artefact.size();
  }
  /// Where the identifiable columns are among the estimated ones.
  [[nodiscard]] std::vector<Eigen::Index> positions() const {
    std::vector<Eigen::Index> positions;
    for (const int column : identifiable_.columns) {
      positions.push_back(std::ranges::find(estimated_, column) - estimated_.begin());
    }
    return positions;
  }

  /// One row a touch, over the noise.
  Eigen::MatrixXd rows(std::vector<Touch> touches) { return linearised(std::move(touches)).rows(); }
  /// What priors and certified lengths tell.
  Eigen::MatrixXd prior() { return linearised({}).information(); }

  /// Whether these touches determine all unknowns.
  bool is_shown_by(std::vector<Touch> touches) { return linearised(std::move(touches)).solve(); }

  ExpectedFigures figures(std::vector<Touch> touches) {
    LeastSquares fit = linearised(std::move(touches));
    if (!fit.solve()) throw std::invalid_argument("the touches do not show all that is to be identified");
    const Linearisation whole = linearise_whole(options_, fit, nominal_);
    return {certainty(problem_, options_, identifiable_, fit, whole, nominal_, std::nullopt),
            fit.conditions(positions()).condition_number};
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

/// Which touches are fitted, with the criterion's figure made as small as exchange makes it.
class Chooser {
 public:
  Chooser(const PlanningProblem& problem, std::span<const TouchCandidate> candidates, Expectation& expected)
      : problem_(problem),
        candidates_(candidates),
        expected_(expected),
        region_(region_of(problem)),
        exchange_(exchange_of(problem, candidates, expected)) {
    if (by_tip()) exchange_.weigh(weight());
  }

  void restart(const std::vector<std::size_t>& chosen) { exchange_.restart(chosen); }

  void settle(int count) {
    if (static_cast<int>(exchange_.chosen().size()) > count) {
      exchange_.shrink(count);
    } else {
      exchange_.grow(count);
    }
    for (int round = 0; round < kRoundsMax && exchange_.improve(kWorthIt); ++round) {
    }
    if (problem_.goal.criterion == PlanCriterion::kConditionNumber) lower_condition_number(exchange_);
  }

  [[nodiscard]] const std::vector<std::size_t>& chosen() const { return exchange_.chosen(); }

  /// Nothing when the region holds no posture.
  [[nodiscard]] std::optional<double> tip_rms_m() const {
    return region_.rms_m(expected_.figures(touches()).certainty.covariance());
  }

  /// Whether the chosen touches show all that is to be identified.
  [[nodiscard]] bool is_determined() const { return expected_.is_shown_by(touches()); }

  /// Whether a tip error is asked for that no posture has.
  [[nodiscard]] bool is_region_missing() const {
    return region_.posture_count == 0 && (by_tip() || problem_.goal.tip_rms_max_m);
  }

  /// What is chosen, and that it is not enough.
  [[nodiscard]] ChoiceFailure not_enough() const {
    const Certainty certainty = expected_.figures(touches()).certainty;
    const auto rms_m = [&](const UncertaintySource& source) { return *region_.rms_m(source.covariance); };
    const UncertaintySource& most = *std::ranges::max_element(certainty.sources, {}, rms_m);
    const double best_m = *region_.rms_m(certainty.covariance());
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
               ? over_joint_ranges(arm, problem.joint_ranges)
               : over_box(arm, problem.joint_ranges, problem.workspace_box);
  }

  /// What an error of the unknowns does to the tip; what is wrong with the artefact alone does nothing.
  [[nodiscard]] Eigen::MatrixXd weight() const {
    const std::vector<int>& columns = expected_.estimated();
    Eigen::MatrixXd weight = Eigen::MatrixXd::Zero(expected_.unknown_count(), expected_.unknown_count());
    const auto count = std::ssize(columns);
    weight.topLeftCorner(count, count) = region_.mean_square(columns, columns);
    return weight;
  }

  /// Over all unknowns for the tip error, else over the identifiable errors of the arm alone.
  TouchExchange exchange_of(const PlanningProblem& problem, std::span<const TouchCandidate> candidates,
                            Expectation& expected) const {
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
    return TouchExchange(rows, faces, std::move(bounds), std::move(prior));
  }

  const PlanningProblem& problem_;
  std::span<const TouchCandidate> candidates_;
  Expectation& expected_;
  TipRegion region_;
  TouchExchange exchange_;
};

/// The fewest touches that reach the wanted accuracy; goal.fit_count are chosen already.
std::optional<ChoiceFailure> settle_fewest(const PlanningProblem& problem, Chooser& chooser, int least) {
  const double wanted_m = *problem.goal.tip_rms_max_m;
  const auto reaches = [&](int count) {
    chooser.settle(count);
    return chooser.is_determined() && chooser.tip_rms_m().value() <= wanted_m;
  };
  if (chooser.tip_rms_m().value() > wanted_m) return chooser.not_enough();
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

/// What makes touches of a face alike: the place on the face in quarters of its extents, the direction of the
/// stylus, and joints 1 to 3 in radians. The turn about the stylus is left out: it tells nothing.
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
  return select_apart(touch_features(problem, candidates), faces, quotas, fit);
}

/// As many as the faces must have, and as there are unknowns of the arm.
int least_count(const PlanningProblem& problem, const Expectation& expected) {
  int count = 0;
  for (const TouchRequest& request : problem.requests) count += request.fit_min;
  return std::max(count, static_cast<int>(expected.identifiable().size()));
}

}  // namespace

std::variant<TouchChoice, ChoiceFailure> choose_touches(const PlanningProblem& problem,
                                                        std::span<const TouchCandidate> candidates,
                                                        const std::function<void(double)>& progress) {
  Expectation expected(problem);
  Chooser chooser(problem, candidates, expected);
  if (chooser.is_region_missing()) {
    return ChoiceFailure{
        .reason = "no posture in the joint ranges has the tip in the region that it is to be right in"};
  }
  if (progress) progress(0.2);
  chooser.settle(problem.goal.fit_count);
  if (!chooser.is_determined()) {
    return ChoiceFailure{.kind = ChoiceFailure::Kind::kPlanes,
                         .reason = "the touches do not show all that is to be identified"};
  }
  if (problem.goal.tip_rms_max_m) {
    if (auto failure = settle_fewest(problem, chooser, least_count(problem, expected))) return *failure;
  }
  if (progress) progress(0.9);
  TouchChoice choice{.fit = chooser.chosen(), .held_out = {}, .tip_rms_m = chooser.tip_rms_m()};
  choice.held_out = held_out(problem, candidates, choice.fit);
  return choice;
}

ExpectedFigures expected_figures(const PlanningProblem& problem, std::span<const Touch> touches) {
  return Expectation(problem).figures({touches.begin(), touches.end()});
}

}  // namespace calib
