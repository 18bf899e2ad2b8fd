#include "calib_core/planning/internal/route_improvement.hpp"

#include <algorithm>
#include <utility>

#include "calib_core/planning/internal/face_interleaving.hpp"

namespace calib {
namespace {

constexpr double kSavingMinSeconds = 1e-6;
constexpr std::size_t kMovedTogetherMax = 3;

/// The section of the route that is reordered.
class Section {
 public:
  Section(const RouteProblem& problem, std::vector<std::size_t>& order, std::size_t counted_from,
          std::size_t begin, std::size_t end)
      : problem_(problem),
        order_(order),
        counted_from_(counted_from),
        begin_(begin),
        end_(end),
        repeats_(repeats(order)),
        violations_(violations(order)) {}

  /// One round of changes; false when none was accepted.
  bool improve() {
    bool improved = false;
    for (std::size_t i = begin_; i < end_; ++i) {
      for (std::size_t j = i + 1; j < end_; ++j) {
        improved |= try_reversal(i, j);
        improved |= try_exchange(i, j);
      }
      for (std::size_t length = 1; length <= kMovedTogetherMax && i + length <= end_; ++length) {
        for (std::size_t to = begin_; to + length <= end_; ++to) improved |= try_move(i, length, to);
      }
    }
    return improved;
  }

 private:
  [[nodiscard]] double seconds(std::size_t a, std::size_t b) const {
    return problem_.seconds(static_cast<Eigen::Index>(a), static_cast<Eigen::Index>(b));
  }
  /// Travel time between the stops at two adjacent positions; 0 after the last.
  [[nodiscard]] double leg_s(std::size_t before, std::size_t after) const {
    return after < order_.size() ? seconds(order_[before], order_[after]) : 0.0;
  }
  [[nodiscard]] double leg_s(std::size_t before, std::size_t stop, std::size_t after) const {
    const double in_s = seconds(order_[before], stop);
    return after < order_.size() ? in_s + seconds(stop, order_[after]) : in_s;
  }

  [[nodiscard]] int violations(const std::vector<std::size_t>& order) const {
    std::vector<int> faces;
    faces.reserve(end_ - counted_from_);
    for (std::size_t i = counted_from_; i < end_; ++i) faces.push_back(problem_.faces[order[i]]);
    return interleaving_violations(faces);
  }
  /// How often a face follows itself, including the stops before and after the section.
  [[nodiscard]] int repeats(const std::vector<std::size_t>& order) const {
    int count = 0;
    for (std::size_t i = std::max<std::size_t>(counted_from_, 1); i < std::min(end_ + 1, order.size()); ++i) {
      if (problem_.faces[order[i]] == problem_.faces[order[i - 1]]) ++count;
    }
    return count;
  }

  /// Accepts the changed order when its interleaving is not worse.
  bool accept(double saved_s, std::vector<std::size_t>& changed) {
    if (saved_s <= kSavingMinSeconds) return false;
    const int changed_repeats = repeats(changed), changed_violations = violations(changed);
    if (changed_repeats > repeats_ || changed_violations > violations_) return false;
    repeats_ = changed_repeats;
    violations_ = changed_violations;
    order_.swap(changed);
    return true;
  }

  [[nodiscard]] auto at(std::size_t place) const {
    return static_cast<std::vector<std::size_t>::difference_type>(place);
  }

  bool try_reversal(std::size_t first, std::size_t last) {
    double saved_s = leg_s(first - 1, first) + leg_s(last, last + 1) - leg_s(first - 1, last);
    if (last + 1 < order_.size()) saved_s -= seconds(order_[first], order_[last + 1]);
    if (saved_s <= kSavingMinSeconds) return false;
    changed_ = order_;
    std::reverse(changed_.begin() + at(first), changed_.begin() + at(last + 1));
    return accept(saved_s, changed_);
  }

  bool try_exchange(std::size_t a, std::size_t b) {
    if (b - a < 2) return false;  // adjacent: a reversal
    const double saved_s = leg_s(a - 1, order_[a], a + 1) + leg_s(b - 1, order_[b], b + 1) -
                           leg_s(a - 1, order_[b], a + 1) - leg_s(b - 1, order_[a], b + 1);
    if (saved_s <= kSavingMinSeconds) return false;
    changed_ = order_;
    std::swap(changed_[a], changed_[b]);
    return accept(saved_s, changed_);
  }

  /// Moves `length` stops from position `first` to position `to`.
  bool try_move(std::size_t first, std::size_t length, std::size_t to) {
    if (to == first) return false;
    const std::size_t after = first + length;
    // The moved stops come between these positions.
    const std::size_t before_there = to < first ? to - 1 : to + length - 1;
    const std::size_t after_there = before_there + 1;
    double saved_s = leg_s(first - 1, first) + leg_s(after - 1, after) + leg_s(before_there, after_there);
    if (after < order_.size()) saved_s -= seconds(order_[first - 1], order_[after]);
    saved_s -= seconds(order_[before_there], order_[first]);
    if (after_there < order_.size()) saved_s -= seconds(order_[after - 1], order_[after_there]);
    if (saved_s <= kSavingMinSeconds) return false;
    changed_ = order_;
    const auto start = changed_.begin();
    if (to < first) {
      std::rotate(start + at(to), start + at(first), start + at(after));
    } else {
      std::rotate(start + at(first), start + at(after), start + at(after_there));
    }
    return accept(saved_s, changed_);
  }

  const RouteProblem& problem_;
  std::vector<std::size_t>& order_;
  std::size_t counted_from_, begin_, end_;
  int repeats_, violations_;
  std::vector<std::size_t> changed_;
};

}  // namespace

double route_time_s(const RouteProblem& problem, std::span<const std::size_t> order) {
  double sum = 0.0;
  for (std::size_t i = 1; i < order.size(); ++i) {
    sum += problem.seconds(static_cast<Eigen::Index>(order[i - 1]), static_cast<Eigen::Index>(order[i]));
  }
  return sum;
}

void improve_route(const RouteProblem& problem, std::vector<std::size_t>& order, std::size_t counted_from,
                   std::size_t begin, std::size_t end) {
  constexpr int kRoundsMax = 50;
  Section section(problem, order, counted_from, begin, end);
  for (int round = 0; round < kRoundsMax && section.improve(); ++round) {
  }
}

}  // namespace calib
