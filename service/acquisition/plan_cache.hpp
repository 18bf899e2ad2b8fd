#pragma once

#include <boost/asio/any_io_executor.hpp>
#include <boost/asio/awaitable.hpp>
#include <boost/asio/thread_pool.hpp>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <tuple>
#include <variant>

#include "config/cell.hpp"
#include "service/documents/plan.hpp"

namespace cell {

/// A recipe's plan, or why there is none: the same whenever it is asked for.
using PlanOutcome = std::variant<std::shared_ptr<const Plan>, PlanRefusal>;

/// The plans of a cell, by recipe and the block's temperature. Planning takes seconds and has its own thread;
/// everything else runs on the executor's.
class PlanCache {
 public:
  /// `cell` must outlive it. Call clear() when its block is found elsewhere.
  PlanCache(boost::asio::any_io_executor executor, const Cell& cell)
      : executor_(std::move(executor)), cell_(cell) {}
  ~PlanCache() { planner_.join(); }
  PlanCache(const PlanCache&) = delete;
  PlanCache& operator=(const PlanCache&) = delete;

  /// Plans a recipe of the cell, unless it has been planned; again when clear() was called meanwhile. What
  /// the planner throws becomes a refusal. `given`: a temperature of the block in place of the cell's; of
  /// each recipe the plan with the latest one is kept.
  boost::asio::awaitable<PlanOutcome> plan(std::string recipe, std::optional<BlockTemperature> given = {});
  /// The same without waiting: `done` is called when planned() has the outcome.
  void begin(std::string recipe, std::optional<BlockTemperature> given, std::function<void()> done);
  /// What plan() gave; nothing before.
  [[nodiscard]] std::optional<PlanOutcome> planned(const std::string& recipe,
                                                   const std::optional<BlockTemperature>& given = {}) const;
  [[nodiscard]] bool is_planning() const { return under_way_count_ > 0; }
  /// Null when no plan for the cell's own temperature that is kept has this id.
  [[nodiscard]] std::shared_ptr<const Plan> plan_with_id(const std::string& id) const;
  /// Discards all plans, also one that is being made: the block was found elsewhere.
  void clear();

 private:
  /// Recipe, temperature and its standard deviation; those nothing for the cell's own.
  using Key = std::tuple<std::string, std::optional<double>, std::optional<double>>;
  [[nodiscard]] Key key_of(const std::string& recipe, const std::optional<BlockTemperature>& given) const;
  void keep(const Key& key, const PlanOutcome& made);

  boost::asio::any_io_executor executor_;
  const Cell& cell_;
  boost::asio::thread_pool planner_{1};
  std::map<Key, PlanOutcome> plans_;
  int under_way_count_ = 0;  // on the planner's thread, or waiting for it
  int clear_count_ = 0;      // a plan that was begun before the last one is none
};

}  // namespace cell
