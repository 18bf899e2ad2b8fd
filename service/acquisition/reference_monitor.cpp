#include "service/acquisition/reference_monitor.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "calib_core/geometry/units.hpp"

namespace cell {

void ReferenceMonitor::begin_run(int every) {
  every_ = every;
  begin_place(0);
}

void ReferenceMonitor::begin_place(int earlier) {
  earlier_ = earlier;
  place_.reset();
}

void ReferenceMonitor::note_fitted(const calib::PlannedTouch& planned, const calib::JointVector& contact) {
  if (place_ || every_ == 0 || planned.role != calib::TouchRole::kFit) return;
  place_ = Place{.planned = planned, .first_joints = contact, .aimed = {}, .reference = {}};
}

void ReferenceMonitor::restore(const calib::PlannedTouch& planned, const calib::JointVector& contact,
                               const std::optional<calib::JointVector>& reference, int earlier, int count) {
  if (every_ == 0) return;
  earlier_ = earlier;
  place_ = Place{.planned = planned,
                 .first_joints = contact,
                 .aimed = {},
                 .reference = reference,
                 .count = count,
                 .due = true};
}

void ReferenceMonitor::make_due() {
  if (place_) place_->due = true;
}

bool ReferenceMonitor::is_due(int touches_done, bool all_made) const {
  if (!place_) return false;
  if (place_->count == 0 || place_->due) return true;
  return touches_done != place_->made_at && (touches_done % every_ == 0 || all_made);
}

ReferenceMonitor::Reading ReferenceMonitor::add_contact(const calib::JointVector& contact, int touches_done,
                                                        const HeightM& height_m) {
  ++place_->count;
  place_->made_at = touches_done;
  place_->due = false;
  const bool is_first = !place_->reference;
  if (is_first) place_->reference = contact;
  place_->drift_m = height_m(contact) - height_m(*place_->reference);
  return {.number = earlier_ + place_->count,
          .drift_m = place_->drift_m,
          .told_m = is_first ? std::nullopt : std::optional(place_->drift_m)};
}

std::optional<ReferenceMonitor::Doubt> ReferenceMonitor::doubt(const calib::JointVector& contact,
                                                               double limit_m, const HeightM& height_m) {
  if (place_->reference || place_->trusts_next) return std::nullopt;
  const double from_plan_m = height_m(contact) - height_m(place_->first_joints);
  if (std::abs(from_plan_m) <= limit_m) return std::nullopt;
  const auto before = std::exchange(place_->doubted, contact);
  const double from_plan_mm = calib::mm_from_metres(from_plan_m);
  if (!before)
    return Doubt{.warning = Fault{FaultCode::kFirstTouchBiased,
                                  fmt::format("by {:.3f} mm; it is touched again", from_plan_mm)},
                 .hold = {}};
  const double from_before_m = height_m(contact) - height_m(*before);
  if (std::abs(from_before_m) <= limit_m) return std::nullopt;
  return Doubt{.warning = {},
               .hold = Fault{FaultCode::kReferenceDrift,
                             fmt::format("by {:.3f} mm from the touch of the plan there, and by {:.3f} mm "
                                         "from its repetition before, over {:.3f} mm",
                                         from_plan_mm, calib::mm_from_metres(from_before_m),
                                         calib::mm_from_metres(limit_m))}};
}

std::optional<Fault> ReferenceMonitor::drift_fault(double limit_m) const {
  if (std::abs(place_->drift_m - place_->allowed_drift_m) <= limit_m) return std::nullopt;
  return Fault{FaultCode::kReferenceDrift,
               fmt::format("by {:.3f} mm, over {:.3f} mm", calib::mm_from_metres(place_->drift_m),
                           calib::mm_from_metres(limit_m))};
}

void ReferenceMonitor::allow_drift() {
  place_->allowed_drift_m = place_->drift_m;
  place_->trusts_next = true;
}

void ReferenceMonitor::skip(int touches_done) {
  place_->made_at = touches_done;
  place_->count = std::max(place_->count, 1);
  place_->due = false;
}

}  // namespace cell
