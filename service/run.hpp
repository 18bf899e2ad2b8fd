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

  void set_plan(calib::TouchPlan plan) { plan_ = std::move(plan); }
  [[nodiscard]] int touches_total() const { return static_cast<int>(plan_.touches.size()); }
  [[nodiscard]] int touches_done() const { return static_cast<int>(touches_.size()); }
  [[nodiscard]] bool complete() const { return touches_total() > 0 && touches_done() == touches_total(); }
  /// The touch to make now, or null when all are made.
  [[nodiscard]] const calib::PlannedTouch* next() const;

  /// The one behind it, or null.
  [[nodiscard]] const calib::PlannedTouch* after_next() const;

  /// Stores the touch, then counts it. Throws what the store throws; the touch does not count then.
  void add(TouchStore& store, const StoredTouch& touch);
  /// Makes latest() from all touches; false when it is. Apart from add(), as it takes its time.
  bool identify();

  [[nodiscard]] const std::vector<StoredTouch>& touches() const { return touches_; }
  /// What identify() works on.
  [[nodiscard]] const calib::IdentificationProblem& problem() const { return problem_; }
  [[nodiscard]] const calib::IdentificationResult& latest() const { return latest_; }
  /// Predicted over the workspace box; nothing as long as there is no honest figure.
  [[nodiscard]] std::optional<double> predicted_tip_rms_m() const { return predicted_tip_rms_m_; }

 private:
  std::int64_t id_;
  const TipRegions& regions_;
  Recipe recipe_;
  std::string started_at_;
  calib::TouchPlan plan_;
  std::vector<StoredTouch> touches_;
  calib::IdentificationProblem problem_;
  std::size_t identified_count_ = 0;  // of the touches
  calib::IdentificationResult latest_;
  std::optional<double> predicted_tip_rms_m_;
};

}  // namespace cell
