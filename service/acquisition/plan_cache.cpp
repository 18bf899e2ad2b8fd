// Each co_await stands alone in its statement, see cs8_controller.cpp.
#include "service/acquisition/plan_cache.hpp"

#include <boost/asio/bind_executor.hpp>
#include <boost/asio/co_spawn.hpp>
#include <boost/asio/post.hpp>
#include <boost/asio/use_awaitable.hpp>

namespace cell {

namespace asio = boost::asio;

namespace {

/// On the planner's thread: nothing may be thrown there, the coroutine would go on beside the sockets.
PlanOutcome make_outcome(const Cell& cell, const Recipe& recipe) {
  try {
    const TipRegions regions(cell);  // those of the status are for the other thread
    auto made = make_plan(regions, recipe);
    if (auto* refusal = std::get_if<PlanRefusal>(&made)) return std::move(*refusal);
    return std::make_shared<const Plan>(std::get<Plan>(std::move(made)));
  } catch (const std::exception& error) {
    return PlanRefusal{.message = std::string("planning failed: ") + error.what(), .efforts = {}};
  }
}

}  // namespace

asio::awaitable<PlanOutcome> PlanCache::plan(std::string recipe) {
  for (;;) {
    if (const auto made = plans_.find(recipe); made != plans_.end()) co_return made->second;
    const auto cell = std::make_shared<const Cell>(cell_);  // as it stands now
    const int clear_count = clear_count_;
    ++under_way_count_;
    co_await asio::post(asio::bind_executor(planner_.get_executor(), asio::use_awaitable));
    const PlanOutcome made = make_outcome(*cell, cell->recipes.at(recipe));
    co_await asio::post(asio::bind_executor(executor_, asio::use_awaitable));
    --under_way_count_;
    if (clear_count == clear_count_) plans_.emplace(recipe, made);
  }
}

void PlanCache::begin(std::string recipe, std::function<void()> done) {
  asio::co_spawn(executor_, plan(std::move(recipe)), [done = std::move(done)](auto&&...) { done(); });
}

std::optional<PlanOutcome> PlanCache::planned(const std::string& recipe) const {
  const auto found = plans_.find(recipe);
  return found == plans_.end() ? std::nullopt : std::optional(found->second);
}

std::shared_ptr<const Plan> PlanCache::plan_with_id(const std::string& id) const {
  for (const auto& [recipe, outcome] : plans_) {
    const auto* plan = std::get_if<std::shared_ptr<const Plan>>(&outcome);
    if (plan && (*plan)->id == id) return *plan;
  }
  return nullptr;
}

void PlanCache::clear() {
  plans_.clear();
  ++clear_count_;
}

}  // namespace cell
