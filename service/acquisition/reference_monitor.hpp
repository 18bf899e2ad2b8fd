#pragma once

#include <functional>
#include <optional>

#include "calib_core/geometry/joint_vector.hpp"
#include "calib_core/planning/aimed_touch.hpp"
#include "calib_core/planning/online_estimate.hpp"
#include "service/run/fault_table.hpp"

namespace cell {

/// Shows drift during a run: touches one place again and again in the same way, that of the first fitted
/// touch. These touches are not part of the plan: neither counted nor fitted. Pure steps: it says when the
/// place is due and judges the contacts; the touch executor makes them.
class ReferenceMonitor {
 public:
  /// Where a contact has the ball along the place's outward normal, as the arm is known now, metres.
  using HeightM = std::function<double(const calib::JointVector&)>;

  /// One contact at the place.
  struct Reading {
    int number = 0;                // from 1
    double drift_m = 0.0;          // against the first one
    std::optional<double> told_m;  // the same; nothing of the first one, which drift counts from
  };
  /// Why a contact is no reference yet; one of both.
  struct Doubt {
    std::optional<Fault> warning;  // the place is touched again
    std::optional<Fault> hold;     // a person looks at it
  };

  /// Begins a run with a reference touch after every `every` touches; 0: never.
  void begin_run(int every);
  /// The block stands elsewhere: another touch sets the place; the contacts are counted on.
  void begin_place() { begin_place(earlier_ + (place_ ? place_->count : 0)); }
  void begin_place(int earlier);
  /// The touch that set the place counts no longer, and it was not touched again yet: another one sets it.
  void forget_untouched() {
    if (place_ && place_->count == 0) place_.reset();
  }
  /// Notes a fitted touch of the plan; the first one sets the reference place.
  void note_fitted(const calib::PlannedTouch& planned, const calib::JointVector& contact);
  /// A restarted daemon knows the place again, with the first contact there and the count of them, where
  /// there was one, and with how many there were `earlier` at other places; it is due before anything else.
  void restore(const calib::PlannedTouch& planned, const calib::JointVector& contact,
               const std::optional<calib::JointVector>& reference, int earlier, int count);

  /// Before anything else: the arm may have been moved or loaded since the last touch. Nothing without a
  /// place.
  void make_due();

  /// True at the start, after every `every` touches, and at the end.
  [[nodiscard]] bool is_due(int touches_done, bool all_made) const;
  /// The touch of the place, which must be known.
  [[nodiscard]] const calib::PlannedTouch& planned() const { return place_->planned; }
  [[nodiscard]] const std::optional<calib::AimedTouch>& aimed() const { return place_->aimed; }
  /// Sets how the place is touched from now on.
  void set_aimed(calib::AimedTouch aimed) { place_->aimed = std::move(aimed); }

  /// Looks at a contact before it counts. The reference is a contact that agrees with the touch of the plan
  /// at this place, or with the contact before it: one that lies apart from both would make the whole run
  /// drift. Nothing when it counts.
  std::optional<Doubt> doubt(const calib::JointVector& contact, double limit_m, const HeightM& height_m);
  Reading add_contact(const calib::JointVector& contact, int touches_done, const HeightM& height_m);
  /// The place has drifted, by the last contact.
  [[nodiscard]] std::optional<Fault> drift_fault(double limit_m) const;

  // A person's answer to a hold.
  void look_again() { place_->due = true; }
  void allow_drift();
  void skip(int touches_done);

 private:
  struct Place {
    calib::PlannedTouch planned;
    calib::JointVector first_joints;              // of the plan's own touch there
    std::optional<calib::AimedTouch> aimed;       // how it is made
    std::optional<calib::JointVector> reference;  // its first contact, which drift counts from
    std::optional<calib::JointVector> doubted;    // the latest contact that was no reference
    bool trusts_next = false;                     // by a person's word the next contact is the reference
    int count = 0;                                // contacts there
    int made_at = -1;                             // touches done when the last one was made
    double drift_m = 0.0;                         // of the last one
    double allowed_drift_m = 0.0;                 // what a person has let pass
    bool due = false;                             // whatever is done: a daemon restarted, or a person asked
  };

  int every_ = 0;
  int earlier_ = 0;  // contacts at the places where the block stood before
  std::optional<Place> place_;
};

}  // namespace cell
