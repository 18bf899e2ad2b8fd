#pragma once

#include <optional>
#include <set>
#include <string>
#include <variant>
#include <vector>

#include "calib_core/identification/identification_result.hpp"
#include "calib_core/planning/aimed_touch.hpp"
#include "calib_core/planning/online_estimate.hpp"
#include "service/run/fault_table.hpp"
#include "service/store/run_store.hpp"

namespace cell {

/// Numbers of the touches that do not fit what is known of all of them: those that the result leaves out, the
/// farthest off first, then those that the estimate of the run ignores.
std::vector<int> suspects_of(const calib::IdentificationResult& result, const calib::OnlineArmEstimate& aim);

/// Repeats a touch in the same way when the others contradict it: the last one at once, an earlier one when
/// all are made, since little was known when it came. Pure steps: it judges the repetition; the touch
/// executor makes the touch and acts on the finding.
class OutlierRetest {
 public:
  struct Suspect {
    int number = 0;                    // of the touch
    calib::AimedTouch aimed;           // how it is made
    calib::OnlineArmEstimate without;  // the estimate without it; at the end that of all touches
    bool at_end = false;               // all touches are made
  };
  /// Both touches agree, or neither fits at the end: the first one stays, with a warning.
  struct Confirmed {
    Fault warning;
  };
  /// The repetition fits the others and replaces the touch.
  struct Replaced {
    StoredTouch again;
    calib::OnlineArmEstimate aim;  // with the repetition instead
  };
  /// Neither fits: a person is asked.
  struct Held {
    Fault fault;
  };
  using Finding = std::variant<Confirmed, Replaced, Held>;

  /// Begins a run: no touch of it was made again.
  void begin_run();
  void begin(Suspect suspect);
  [[nodiscard]] bool is_due() const { return suspect_.has_value(); }
  /// It must be due.
  [[nodiscard]] const Suspect& suspect() const { return *suspect_; }
  /// Each touch is made again once.
  [[nodiscard]] bool was_made_again(int number) const { return made_again_.contains(number); }
  /// What a person reads of the suspects that are left when none is made again.
  [[nodiscard]] Fault warning_of(const std::vector<int>& suspects) const;

  /// `first` is the touch as it is stored, `again` the same with what its repetition gave; `apart_m` lies
  /// between both along the face's normal and `agreement_m` is the most of two touches of one place.
  [[nodiscard]] Finding judge(const StoredTouch& first, const StoredTouch& again, double apart_m,
                              double agreement_m) const;
  /// Whether the difference of both is noise of a touch: they agree, so that both are believed, and both were
  /// latched, since one that was polled is late. A first touch that its repetition contradicts is a mistake.
  [[nodiscard]] static bool is_pair(const StoredTouch& first, const StoredTouch& again, double apart_m,
                                    double agreement_m);
  void settle() { suspect_.reset(); }

 private:
  std::optional<Suspect> suspect_;
  std::set<int> made_again_;  // by number
};

}  // namespace cell
