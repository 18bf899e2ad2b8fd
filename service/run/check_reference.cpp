#include "service/run/check_reference.hpp"

#include <algorithm>

namespace cell {
namespace {

using calib::kReferenceCount;

class Agreement {
 public:
  Agreement(const calib::KinematicModel& arm, std::span<const ReferenceCandidate> candidates)
      : arm_(arm), candidates_(candidates) {}

  /// Those of `earlier`, oldest first, that agree with `newest` and with each other, and `newest` itself.
  [[nodiscard]] std::vector<std::size_t> with(std::size_t newest,
                                              std::span<const std::size_t> earlier) const {
    std::vector<std::size_t> set{newest};
    for (auto other = earlier.rbegin(); other != earlier.rend(); ++other)
      if (std::ranges::all_of(set, [&](std::size_t one) { return agree(*other, one); }))
        set.push_back(*other);
    std::ranges::reverse(set);
    return set;
  }

 private:
  [[nodiscard]] bool agree(std::size_t one, std::size_t other) const {
    return !calib::why_other_touches(arm_, candidates_[one].time.touches, candidates_[other].time.touches);
  }

  const calib::KinematicModel& arm_;
  std::span<const ReferenceCandidate> candidates_;
};

/// Oldest first, without those that have another number of touches than a check.
std::vector<std::size_t> whole_by_run(std::span<const ReferenceCandidate> candidates) {
  std::vector<std::size_t> whole;
  for (std::size_t i = 0; i < candidates.size(); ++i)
    if (std::ssize(candidates[i].time.touches) == calib::kCheckTouchCount) whole.push_back(i);
  std::ranges::stable_sort(whole, {}, [&](std::size_t i) { return candidates[i].run; });
  return whole;
}

}  // namespace

std::vector<std::size_t> reference_among(const calib::KinematicModel& arm,
                                         std::span<const ReferenceCandidate> candidates) {
  const Agreement agreement(arm, candidates);
  const std::vector<std::size_t> whole = whole_by_run(candidates);
  std::vector<std::size_t> set;
  for (std::size_t i = 0; i < whole.size() && std::ssize(set) < kReferenceCount; ++i)
    set = agreement.with(whole[i], std::span(whole).first(i));
  return set;
}

}  // namespace cell
