#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "calib_core/identification/identify.hpp"
#include "calib_core/planning/touch_planning.hpp"
#include "config/cell.hpp"
#include "service/run/tip_prediction.hpp"
#include "service/run/verification.hpp"
#include "service/store/run_store.hpp"

namespace cell {

/// A stored touch in SI units: the only conversion between the wire and calib_core.
calib::Touch to_touch(const StoredTouch& stored);

/// The stored touches of the reference places: each is the place of the first fitted one of the touches that
/// were made where the block stood then. `faces_per_place`: for all tips; 0: it has stood at one place.
std::vector<calib::Touch> to_touches(const std::vector<ReferenceTouch>& references,
                                     const std::vector<StoredTouch>& touches, int faces_per_place);

/// One execution of a recipe: its plan, the touches so far and the latest result.
class Run {
 public:
  /// `regions`, those of the cell, must outlive the run. `block_temperature`: given for this run, in place of
  /// that of the cell. `verification`: what the touches are held against, null for a calibration.
  /// `qualified`: what a qualification before the run measured of the noise of a touch.
  Run(std::int64_t id, const TipRegions& regions, Recipe recipe, std::string started_at,
      std::optional<BlockTemperature> block_temperature = {},
      std::shared_ptr<const Verification> verification = nullptr,
      std::optional<calib::TouchNoise> qualified = {});

  [[nodiscard]] std::int64_t id() const { return id_; }
  [[nodiscard]] const Recipe& recipe() const { return recipe_; }
  [[nodiscard]] const std::string& started_at() const { return started_at_; }
  /// Null for a calibration.
  [[nodiscard]] const std::shared_ptr<const Verification>& verification() const { return verification_; }
  [[nodiscard]] RunKind kind() const { return verification_ ? verification_->kind : RunKind::kCalibration; }
  [[nodiscard]] const std::optional<BlockTemperature>& block_temperature() const {
    return block_temperature_;
  }

  /// Restores the touches made before a restart of the daemon. `touches_total`: of the plan, which is set
  /// later.
  void restore(const std::vector<StoredTouch>& touches, int touches_total);
  void set_plan(calib::TouchPlan plan);
  /// Touches of the plan, skipped ones included.
  [[nodiscard]] int touches_total() const {
    return plan_.touches.empty() ? restored_total_ : static_cast<int>(plan_.touches.size()) + skipped_count_;
  }
  [[nodiscard]] int touches_done() const { return static_cast<int>(touches_.size()); }
  [[nodiscard]] bool complete() const { return touches_total() > 0 && touches_done() == touches_total(); }
  /// Changes of the plan since it was set, in order; the same changes give the same plan.
  [[nodiscard]] const std::vector<PlanChange>& plan_changes() const { return plan_changes_; }
  void change_plan(const PlanChange& change);
  /// The touch to make now; null when all are made.
  [[nodiscard]] const calib::PlannedTouch* next() const;
  /// The same where the block stands; null also while it is to be moved.
  [[nodiscard]] const calib::PlannedTouch* next_here() const { return planned_here(touches_made()); }
  /// The touch at an index of the plan; null past the last one where the block stands.
  [[nodiscard]] const calib::PlannedTouch* planned_here(std::size_t index) const;
  /// Where the block stands, or came from while it is to be moved: an index of the recipe's places
  /// (config/touched_places.hpp).
  [[nodiscard]] int place() const { return place_; }
  /// Where a person has been asked to bring the block, until it is there.
  [[nodiscard]] const std::optional<int>& moving_to() const { return moving_to_; }
  /// Where the touch is made, by the index of its face.
  [[nodiscard]] int place_of(int face) const;

  /// The touch at an index of the plan, from 0; null past the end.
  [[nodiscard]] const calib::PlannedTouch* planned(std::size_t index) const;
  /// Index of next() in the plan.
  [[nodiscard]] std::size_t touches_made() const { return touches_.size(); }
  /// Moves the touch at this index after all others of its role and place. False if it was deferred before or
  /// is the last.
  bool defer(std::size_t index);
  /// Predicted remaining time up to the park posture: that of the plan, scaled by the ratio of `elapsed_s` to
  /// the planned time of the touches made.
  [[nodiscard]] double remaining_s(double elapsed_s) const;
  /// Leaves out the touch to make now; the run can no longer be complete. Does nothing if there is none.
  void skip_next();
  [[nodiscard]] int skipped_count() const { return skipped_count_; }
  /// Leaves out the touches to fit from this index on; returns how many.
  int drop_fit_touches(std::size_t first);

  /// Adds a touch that has been stored: what does not outlive the daemon does not count.
  void add(const StoredTouch& touch);
  /// Replaces the touch of the same number; the store has replaced it before.
  void replace(const StoredTouch& again);
  /// Keeps the contact of a repetition that agreed with the touch; the store has it before.
  void confirm(int number, const cs8::JointsMicrodeg& again);
  /// Removes the last touch, which becomes next(); the store has withdrawn it before.
  void withdraw_last();
  /// What the reference place says so far: it counts in latest() from the next identify() on.
  void note_references(std::vector<ReferenceTouch> references);
  /// Computes latest() from all touches; false if it is up to date. Separate from add(), since it is slow.
  bool identify();
  /// Whether latest() is not that of all touches. Those of other kinds are never fitted.
  [[nodiscard]] bool identification_is_due() const {
    return !verification_ && !touches_.empty() && identified_revision_ != revision_;
  }
  /// A copy to call identify() for, on another thread say. From here on latest() counts as that of all
  /// touches, also where the copy is never identified.
  [[nodiscard]] Run copy_to_identify();
  /// Takes over latest() from such a copy. False when it is one of another run, when nothing was computed, or
  /// what it was computed from has changed since.
  bool take_latest(const Run& identified);

  [[nodiscard]] const std::vector<StoredTouch>& touches() const { return touches_; }
  /// The input of identify().
  [[nodiscard]] const calib::IdentificationProblem& problem() const { return problem_; }
  [[nodiscard]] const calib::IdentificationResult& latest() const { return latest_; }
  /// Predicted over the workspace box; absent while it cannot be computed.
  [[nodiscard]] std::optional<double> predicted_tip_rms_m() const { return predicted_tip_rms_m_; }
  /// True if the recipe's accuracy goal is met: the predicted tip error is within it, every attainable
  /// parameter is identified and the residuals agree with the touch noise. False for a recipe without a goal.
  [[nodiscard]] bool meets_accuracy_goal() const;
  /// Which further touches would lower predicted_tip_rms_m() most, in words; absent before all attainable
  /// parameters are identified.
  [[nodiscard]] const std::optional<std::string>& touch_benefit() const { return touch_benefit_; }

 private:
  void skip(std::size_t index);
  /// Touches or references have changed.
  void revise();
  [[nodiscard]] bool sees_all_attainable() const;
  [[nodiscard]] std::optional<std::string> estimate_touch_benefit() const;

  std::int64_t id_;
  const TipRegions& regions_;
  Recipe recipe_;
  std::string started_at_;
  std::optional<BlockTemperature> block_temperature_;
  std::shared_ptr<const Verification> verification_;
  std::optional<calib::TouchNoise> qualified_;
  calib::TouchPlan plan_;
  std::vector<bool> deferred_;  // one a planned touch
  int place_ = 0;
  std::optional<int> moving_to_;
  int skipped_count_ = 0;  // no longer in the plan
  std::vector<PlanChange> plan_changes_;
  int restored_total_ = 0;  // while there is no plan
  std::vector<StoredTouch> touches_;
  std::vector<ReferenceTouch> references_;
  calib::IdentificationProblem problem_;
  std::size_t revision_ = 0;             // of the touches and references: counts their changes
  std::size_t identified_revision_ = 0;  // from which latest_ is
  calib::IdentificationResult latest_;
  std::optional<double> predicted_tip_rms_m_;
  std::optional<std::string> touch_benefit_;
};

}  // namespace cell
