#pragma once

#include <optional>
#include <string>
#include <variant>

#include "calib_core/planning/aimed_touch.hpp"
#include "calib_core/planning/online_estimate.hpp"
#include "service/run/fault_table.hpp"
#include "service/store/run_store.hpp"

namespace cell {

/// Repeats the last touch in the same way when the others contradict it. Pure steps: it judges the
/// repetition; the touch executor makes the touch and acts on the finding.
class OutlierRetest {
 public:
  /// Both touches agree: the first one stays, with a warning.
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

  /// The touch just made contradicts the others: how it was aimed, and the estimate without it.
  void begin(calib::AimedTouch aimed, calib::OnlineArmEstimate without) {
    suspect_ = {std::move(aimed), std::move(without)};
  }
  [[nodiscard]] bool is_due() const { return suspect_.has_value(); }
  /// Of the suspect: it must be due.
  [[nodiscard]] const calib::AimedTouch& aimed() const { return suspect_->aimed; }
  [[nodiscard]] const calib::OnlineArmEstimate& without() const { return suspect_->without; }

  /// `first` is the touch as it is stored, `again` the same with what its repetition gave; `apart_m` lies
  /// between both along the face's normal and `agreement_m` is the most of two touches of one place.
  [[nodiscard]] Finding judge(const StoredTouch& first, const StoredTouch& again, double apart_m,
                              double agreement_m) const;
  void settle() { suspect_.reset(); }

 private:
  struct Suspect {
    calib::AimedTouch aimed;
    calib::OnlineArmEstimate without;
  };

  std::optional<Suspect> suspect_;
};

}  // namespace cell
