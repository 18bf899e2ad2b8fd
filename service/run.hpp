#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "calib_core/identify.hpp"
#include "calib_core/touch_planning.hpp"
#include "config/cell.hpp"
#include "service/store/touch_store.hpp"
#include "service/tip_prediction.hpp"

namespace cell {

/// A stored touch in SI units: the only unit change on the way from the wire to the core.
calib::Touch to_touch(const StoredTouch& stored);

/// One execution of a recipe: the touches so far and the latest result. The one mutable object of a run.
class Run {
 public:
  /// `regions`, those of the cell, must outlive the run.
  Run(std::int64_t id, const TipRegions& regions, Recipe recipe, std::string started_at);

  [[nodiscard]] std::int64_t id() const { return id_; }
  [[nodiscard]] const Recipe& recipe() const { return recipe_; }
  [[nodiscard]] const std::string& started_at() const { return started_at_; }

  /// The touches that it made before the daemon was started anew, and how many its plan has, which is not
  /// known here yet.
  void restore(const std::vector<StoredTouch>& touches, int touches_total);
  void set_plan(calib::TouchPlan plan);
  /// Of the plan, those that were skipped among them.
  [[nodiscard]] int touches_total() const {
    return plan_.touches.empty() ? restored_total_ : static_cast<int>(plan_.touches.size()) + skipped_count_;
  }
  [[nodiscard]] int touches_done() const { return static_cast<int>(touches_.size()); }
  [[nodiscard]] bool complete() const { return touches_total() > 0 && touches_done() == touches_total(); }
  /// How the plan was changed since it was set, in order; the same changes give the same plan.
  [[nodiscard]] const std::vector<PlanChange>& plan_changes() const { return plan_changes_; }
  void change_plan(const PlanChange& change);
  /// The touch to make now, or null when all are made.
  [[nodiscard]] const calib::PlannedTouch* next() const;

  /// The touch at a place of the plan, from 0, or null behind the last.
  [[nodiscard]] const calib::PlannedTouch* planned(std::size_t index) const;
  /// How many places of the plan are behind the run: the place of next().
  [[nodiscard]] std::size_t touches_made() const { return touches_.size(); }
  /// The touch at this place comes behind all others of its role. False when it did before, or is the last.
  bool put_off(std::size_t index);
  /// Predicted time of all that is left, to the park posture: the plan's, as much longer or shorter as what
  /// is made took in `elapsed_s`.
  [[nodiscard]] double left_s(double elapsed_s) const;
  /// A person leaves out the touch to make now: the run never becomes complete. Nothing when there is none.
  void skip_next();
  [[nodiscard]] int skipped_count() const { return skipped_count_; }
  /// Leaves out the touches to fit from this place on; how many.
  int drop_fitted(std::size_t first);

  /// One touch more. It is stored before it is added: what does not outlive the daemon does not count.
  void add(const StoredTouch& touch);
  /// The last touch again, in its place; stored before.
  void replace_last(const StoredTouch& again);
  /// The last touch counts no more, as is stored before; it is next() again.
  void withdraw_last();
  /// Makes latest() from all touches; false when it is. Apart from add(), as it takes its time.
  bool identify();

  [[nodiscard]] const std::vector<StoredTouch>& touches() const { return touches_; }
  /// What identify() works on.
  [[nodiscard]] const calib::IdentificationProblem& problem() const { return problem_; }
  [[nodiscard]] const calib::IdentificationResult& latest() const { return latest_; }
  /// Predicted over the workspace box; nothing as long as there is no honest figure.
  [[nodiscard]] std::optional<double> predicted_tip_rms_m() const { return predicted_tip_rms_m_; }
  /// The accuracy that the recipe asks for is reached: the predicted tip error is within it, every parameter
  /// that can be seen is, and the residuals are touch noise. Never where the recipe asks for none.
  [[nodiscard]] bool is_good_enough() const;
  /// What would lower predicted_tip_rms_m() most, in words; nothing before all is seen.
  [[nodiscard]] const std::optional<std::string>& more_would_bring() const { return more_would_bring_; }

 private:
  void skip(std::size_t index);
  [[nodiscard]] bool sees_all() const;
  [[nodiscard]] std::optional<std::string> weigh_more_touches() const;

  std::int64_t id_;
  const TipRegions& regions_;
  Recipe recipe_;
  std::string started_at_;
  calib::TouchPlan plan_;
  std::vector<bool> put_off_;  // one a planned touch
  int skipped_count_ = 0;      // no longer in the plan
  std::vector<PlanChange> plan_changes_;
  int restored_total_ = 0;  // as long as there is no plan
  std::vector<StoredTouch> touches_;
  calib::IdentificationProblem problem_;
  std::size_t identified_count_ = 0;  // of the touches
  calib::IdentificationResult latest_;
  std::optional<double> predicted_tip_rms_m_;
  std::optional<std::string> more_would_bring_;
};

}  // namespace cell
