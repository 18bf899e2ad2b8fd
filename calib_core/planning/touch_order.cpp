#include "calib_core/planning/touch_order.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <set>
#include <span>
#include <utility>

#include "calib_core/kinematics/error_parameters.hpp"
#include "calib_core/motion/motion_time.hpp"
#include "calib_core/motion/transfer_path.hpp"
#include "calib_core/numerics/decompositions.hpp"
#include "calib_core/planning/internal/face_interleaving.hpp"
#include "calib_core/planning/internal/fedorov_exchange.hpp"
#include "calib_core/planning/internal/route_improvement.hpp"
#include "calib_core/planning/transfer_planning.hpp"

namespace calib {
namespace {

/// Number of touches ordered by information, as a multiple of the rank.
constexpr double kInformativeShare = 1.2;
/// Increase of the logarithm of the information determinant that is worth one second of travel.
constexpr double kGainPerSecond = 0.1;
/// Information before the first touch, relative to the scaled columns: small against that of any touch.
constexpr double kOrderRidge = 1e-6;
constexpr double kRankTolerance = 1e-9;
/// Rounds of planning the transfers of the best order and improving the order with their times.
constexpr int kOrderRoundsMax = 4;

/// d signed distance / d error, one row per touch; columns scaled to a root mean square of 1, zero where no
/// touch has an effect.
Eigen::MatrixXd observation_rows(const PlanningProblem& problem, std::span<const PlannedTouch> touches) {
  const PreparedModel model = prepare(problem.nominal);
  Eigen::MatrixXd rows(static_cast<Eigen::Index>(touches.size()), kErrorParameterCount);
  for (std::size_t i = 0; i < touches.size(); ++i) {
    const Chain chain = forward_chain(model, touches[i].joints);
    const Eigen::Vector3d ball_m =
        ball_at_m(touched_surface(problem, touches[i].face), chain.block_from_frame.back());
    rows.row(static_cast<Eigen::Index>(i)) =
        distance_derivatives(model, chain, ball_m, -touches[i].search_direction).head<kErrorParameterCount>();
  }
  const double norm_min = kRankTolerance * rows.colwise().norm().maxCoeff();
  for (auto column : rows.colwise()) {
    const double norm = column.norm();
    column *= norm > norm_min ? std::sqrt(static_cast<double>(rows.rows())) / norm : 0.0;
  }
  return rows;
}

/// A D-optimal design without any chosen touch.
FedorovExchange empty_design(const Eigen::MatrixXd& rows) {
  const auto count = static_cast<std::size_t>(rows.rows());
  return {rows,
          std::vector<int>(count, 0),
          {{.group = 0, .min = 0, .max = static_cast<int>(count)}},
          kOrderRidge * Eigen::MatrixXd::Identity(rows.cols(), rows.cols())};
}

/// The stops of the route: the touches in the given order, then the park posture.
class Stops {
 public:
  Stops(const PlanningProblem& problem, std::span<const PlannedTouch> touches)
      : problem_(problem), model_(prepare(problem.nominal)) {
    for (const PlannedTouch& touch : touches) {
      postures_.push_back(touch.clear_joints);
      faces_.push_back(touch.face);
    }
    postures_.push_back(problem.park_joints);
    faces_.push_back(-1);
    const auto count = static_cast<Eigen::Index>(postures_.size());
    seconds_ = Eigen::MatrixXd::Zero(count, count);
    for (std::size_t a = 0; a < postures_.size(); ++a) {
      for (std::size_t b = 0; b < a; ++b) {
        set_seconds(a, b, path_time_s(model_, problem.motion, std::array{postures_[a], postures_[b]}));
      }
    }
  }

  [[nodiscard]] std::size_t park() const { return postures_.size() - 1; }
  [[nodiscard]] const std::vector<int>& faces() const { return faces_; }
  [[nodiscard]] RouteProblem problem() const { return {seconds_, faces_}; }
  [[nodiscard]] double seconds(std::size_t a, std::size_t b) const {
    return seconds_(static_cast<Eigen::Index>(a), static_cast<Eigen::Index>(b));
  }

  /// Replaces the times of direct moves along the order by those of planned transfers; true when all were
  /// known.
  bool plan_transfers(std::span<const std::size_t> order) {
    bool all_known = true;
    for (std::size_t i = 1; i < order.size(); ++i) {
      const auto pair = std::minmax(order[i - 1], order[i]);
      if (!planned_.emplace(pair.first, pair.second).second) continue;
      all_known = false;
      set_seconds(order[i - 1], order[i], transfer_seconds(order[i - 1], order[i]));
    }
    return all_known;
  }

 private:
  [[nodiscard]] double transfer_seconds(std::size_t from, std::size_t to) const {
    const auto via = find_transfer(problem_, postures_[from], postures_[to]);
    const std::vector<JointVector> through_park{problem_.park_joints};
    return path_time_s(model_, problem_.motion,
                       whole_path(postures_[from], via ? *via : through_park, postures_[to]));
  }
  void set_seconds(std::size_t a, std::size_t b, double seconds) {
    seconds_(static_cast<Eigen::Index>(a), static_cast<Eigen::Index>(b)) = seconds;
    seconds_(static_cast<Eigen::Index>(b), static_cast<Eigen::Index>(a)) = seconds;
  }

  const PlanningProblem& problem_;
  PreparedModel model_;
  std::vector<JointVector> postures_;
  std::vector<int> faces_;
  Eigen::MatrixXd seconds_;
  std::set<std::pair<std::size_t, std::size_t>> planned_;
};

/// The order under construction: the park posture, then touch by touch.
class Ordering {
 public:
  Ordering(const PlanningProblem& problem, std::span<const PlannedTouch> touches)
      : problem_(problem), touches_(touches), stops_(problem, touches), order_{stops_.park()} {
    append_fit();
    append_unfitted();
    order_.push_back(stops_.park());
  }

  /// Improves the order, first as if all direct moves were clear, then with the times of planned transfers.
  void improve() {
    improve_sections();
    std::vector<std::size_t> best;
    double best_s = std::numeric_limits<double>::infinity();
    for (int round = 0; round < kOrderRoundsMax; ++round) {
      const bool all_known = stops_.plan_transfers(order_);
      const double time_s = route_time_s(stops_.problem(), order_);
      if (time_s < best_s) {
        best = order_;
        best_s = time_s;
      }
      if (all_known) break;
      improve_sections();
    }
    order_ = best;
  }

  [[nodiscard]] std::span<const std::size_t> touches() const {
    return std::span(order_).subspan(1, touches_.size());
  }

 private:
  /// Appends the touch with the largest worth(last stop, touch) among the faces that may be next.
  template <class Worth>
  std::size_t append_best(FaceInterleaving& faces, std::vector<std::size_t>& due, const Worth& worth) {
    const std::vector<int> next = faces.next_faces();
    auto best = due.end();
    double best_worth = -std::numeric_limits<double>::infinity();
    for (auto touch = due.begin(); touch != due.end(); ++touch) {
      if (std::ranges::find(next, stops_.faces()[*touch]) == next.end()) continue;
      const double its_worth = worth(order_.back(), *touch);
      if (its_worth > best_worth) {
        best_worth = its_worth;
        best = touch;
      }
    }
    const std::size_t taken = *best;
    due.erase(best);
    faces.take(stops_.faces()[taken]);
    order_.push_back(taken);
    return taken;
  }

  void append_nearest(FaceInterleaving& faces, std::vector<std::size_t>& due) {
    while (!due.empty()) {
      append_best(faces, due, [&](std::size_t from, std::size_t to) { return -stops_.seconds(from, to); });
    }
  }

  void append_fit() {
    std::vector<std::size_t> due = touches_that(true);
    fit_end_ = 1 + due.size();
    if (due.empty()) return;
    FaceInterleaving faces(faces_of(due));
    const Eigen::MatrixXd rows = observation_rows(problem_, touches_);
    FedorovExchange design = empty_design(rows);
    const auto informative = static_cast<std::size_t>(
        std::ceil(kInformativeShare * static_cast<double>(rank(rows, kRankTolerance))));
    informative_end_ = 1 + std::min(due.size(), informative);
    while (order_.size() < informative_end_) {
      design.add(append_best(faces, due, [&](std::size_t from, std::size_t to) {
        return design.gain(to) - kGainPerSecond * stops_.seconds(from, to);
      }));
    }
    append_nearest(faces, due);
  }

  void append_unfitted() {
    std::vector<std::size_t> due = touches_that(false);
    if (due.empty()) return;
    FaceInterleaving faces(faces_of(due), stops_.faces()[order_.back()]);
    append_nearest(faces, due);
  }

  void improve_sections() {
    improve_route(stops_.problem(), order_, 1, informative_end_, fit_end_);
    improve_route(stops_.problem(), order_, fit_end_, fit_end_, order_.size() - 1);
  }

  [[nodiscard]] std::vector<std::size_t> touches_that(bool are_fitted) const {
    std::vector<std::size_t> found;
    for (std::size_t i = 0; i < touches_.size(); ++i) {
      if ((touches_[i].role == TouchRole::kFit) == are_fitted) found.push_back(i);
    }
    return found;
  }
  [[nodiscard]] std::vector<int> faces_of(std::span<const std::size_t> touches) const {
    std::vector<int> faces;
    for (const std::size_t touch : touches) faces.push_back(stops_.faces()[touch]);
    return faces;
  }

  const PlanningProblem& problem_;
  std::span<const PlannedTouch> touches_;
  Stops stops_;
  std::vector<std::size_t> order_;
  std::size_t informative_end_ =
      1;  // positions in the order: after the informative touches, after the last fitted
  std::size_t fit_end_ = 1;
};

/// Finds transfers with the predicted position errors.
class TransferFinder {
 public:
  explicit TransferFinder(const PlanningProblem& problem)
      : problem_(problem), nominal_position_error_m_(problem.nominal_position_error_m) {}

  /// A posture and the position error to keep there.
  struct End {
    JointVector joints;
    double position_error_m = 0.0;
  };
  [[nodiscard]] End end(const PlannedTouch& touch) const {
    return {touch.clear_joints, touch.predicted_position_error_m > 0.0 ? touch.predicted_position_error_m
                                                                       : nominal_position_error_m_};
  }
  [[nodiscard]] End park() const { return {problem_.park_joints, std::numeric_limits<double>::infinity()}; }

  /// Both ends keep the smaller error, for which there is a path; see
  /// PlannedTouch::predicted_position_error_m.
  std::optional<std::vector<JointVector>> find(const End& from, const End& to) {
    problem_.nominal_position_error_m = std::min(from.position_error_m, to.position_error_m);
    return find_transfer(problem_, from.joints, to.joints);
  }

 private:
  PlanningProblem problem_;
  double nominal_position_error_m_;
};

}  // namespace

std::vector<PlannedTouch> order_touches(const PlanningProblem& problem, std::vector<PlannedTouch> touches) {
  Ordering ordering(problem, touches);
  ordering.improve();
  std::vector<PlannedTouch> ordered;
  ordered.reserve(touches.size());
  for (const std::size_t touch : ordering.touches()) ordered.push_back(std::move(touches[touch]));
  return ordered;
}

std::optional<TouchPlan> find_paths(const PlanningProblem& problem, std::vector<PlannedTouch> touches) {
  const PreparedModel model = prepare(problem.nominal);
  TransferFinder finder(problem);
  TransferFinder::End standing = finder.park();
  const auto go = [&](const TransferFinder::End& to, std::vector<JointVector>& via, double& travel_s) {
    auto found = finder.find(standing, to);
    if (!found) return false;
    via = std::move(*found);
    travel_s = path_time_s(model, problem.motion, whole_path(standing.joints, via, to.joints));
    standing = to;
    return true;
  };
  TouchPlan plan{.touches = std::move(touches)};
  for (PlannedTouch& touch : plan.touches) {
    if (!go(finder.end(touch), touch.via, touch.travel_s)) return std::nullopt;
    touch.touch_s =
        touch_time_s(model, problem.motion, {touch.clear_joints, touch.approach_joints, touch.joints});
  }
  if (!go(finder.park(), plan.park_via, plan.park_s)) return std::nullopt;
  return plan;
}

}  // namespace calib
