#pragma once

#include <atomic>
#include <boost/asio/any_io_executor.hpp>
#include <boost/asio/awaitable.hpp>
#include <compare>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <variant>

#include "config/cell.hpp"
#include "service/documents/plan.hpp"

namespace cell {

/// A recipe's plan, or why there is none: the same whenever it is asked for.
using PlanOutcome = std::variant<std::shared_ptr<const Plan>, PlanRefusal>;

/// What a run was started with in place of what the cell's files say: the block's temperature, and whether
/// the compliance is estimated. Of other runs than calibrations also what they are held against, and with it
/// the tool that touches.
struct PlanGiven {
  std::optional<BlockTemperature> block_temperature;
  std::optional<bool> stiffness;
  std::shared_ptr<const Verification> verification = nullptr;
};

/// The cell as a run has it that was started so.
Cell cell_with(const Cell& cell, const PlanGiven& given);

/// The plans of a cell, by recipe and what was given in place of the cell's. Planning takes seconds and is
/// done on the executor that is handed in for it; everything else runs on the other one.
class PlanCache {
 public:
  /// `cell` must outlive it; whoever calls plan() is on `executor`. Call clear() when its block is found
  /// elsewhere.
  PlanCache(boost::asio::any_io_executor executor, boost::asio::any_io_executor planner, const Cell& cell)
      : executor_(std::move(executor)), planner_(std::move(planner)), cell_(cell) {}
  ~PlanCache() { end(); }
  PlanCache(const PlanCache&) = delete;
  PlanCache& operator=(const PlanCache&) = delete;

  /// Plans a recipe of the cell, unless it has been planned; again when clear() was called meanwhile. What
  /// the planner throws becomes a refusal, and so does a plan that was given up for a run's: planned() has
  /// none then. `given`: what the run has in place of the cell's; of each recipe the plan with the latest one
  /// is kept.
  boost::asio::awaitable<PlanOutcome> plan(std::string recipe, PlanGiven given = {});
  /// The same for a run, without waiting: `done` is called when planned() has the outcome. What plan() makes
  /// meanwhile is given up: a run does not wait for a plan that somebody looks at.
  void begin(std::string recipe, PlanGiven given, std::function<void()> done);
  /// Gives up what begin() began last, unless it is done: nobody waits for it any more, and the planner is
  /// free for the next.
  void cancel();
  /// A plan that was made before, of a recipe as the cell's files have it: it is not made again.
  void hand_in(std::shared_ptr<const Plan> plan);
  /// What plan() gave; nothing before.
  [[nodiscard]] std::optional<PlanOutcome> planned(const std::string& recipe,
                                                   const PlanGiven& given = {}) const;
  /// Gives up all that is being planned, and nothing is planned any more: the daemon ends.
  void end() { *ended_ = true; }
  [[nodiscard]] bool is_planning() const { return under_way_count_ > 0; }
  /// Null when no plan that is kept has this id and is of what the cell's files say.
  [[nodiscard]] std::shared_ptr<const Plan> plan_with_id(const std::string& id) const;
  /// Discards all plans, also one that is being made: the block was found elsewhere.
  void clear();

 private:
  struct Key {
    std::string recipe;
    std::optional<double> celsius, std_k;  // nothing for the cell's own
    std::optional<bool> stiffness;         // nothing for the recipe's own
    RunKind kind = RunKind::kCalibration;
    std::optional<std::int64_t> of_run;  // the calibration that touches are held against
    std::string tool;                    // that touches
    auto operator<=>(const Key&) const = default;
    [[nodiscard]] bool is_own() const { return !celsius && !stiffness && kind == RunKind::kCalibration; }
  };
  [[nodiscard]] Key key_of(const std::string& recipe, const PlanGiven& given) const;
  void keep(const Key& key, const PlanOutcome& made);
  using Flag = std::shared_ptr<std::atomic<bool>>;  // set here, read by the planner
  boost::asio::awaitable<PlanOutcome> make(std::string recipe, PlanGiven given, Flag cancelled);

  boost::asio::any_io_executor executor_;
  boost::asio::any_io_executor planner_;
  const Cell& cell_;
  Flag ended_ = std::make_shared<std::atomic<bool>>(false);
  Flag asked_;  // of the latest plan()
  Flag begun_;
  std::map<Key, PlanOutcome> plans_;
  int under_way_count_ = 0;  // on the planner's thread, or waiting for it
  int clear_count_ = 0;      // a plan that was begun before the last one is none
};

}  // namespace cell
