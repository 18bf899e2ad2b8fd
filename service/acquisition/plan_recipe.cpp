// Plans take seconds: they are made on a thread of their own, beside the sockets. Each co_await stands alone
// in its statement, see drive.cpp.
#include <boost/asio/bind_executor.hpp>
#include <boost/asio/post.hpp>
#include <boost/asio/use_awaitable.hpp>

#include "service/acquisition/operation.hpp"

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

/// Again when the block was found elsewhere meanwhile.
asio::awaitable<PlanOutcome> Operation::plan_recipe(std::string name) {
  for (;;) {
    if (const auto made = plans_.find(name); made != plans_.end()) co_return made->second;
    const Cell cell = cell_;
    const int place_count = place_count_;
    ++plans_under_way_;
    co_await asio::post(asio::bind_executor(planner_.get_executor(), asio::use_awaitable));
    const PlanOutcome made = make_outcome(cell, cell.recipes.at(name));
    co_await asio::post(asio::bind_executor(executor_, asio::use_awaitable));
    --plans_under_way_;
    if (place_count == place_count_) plans_.emplace(name, made);
  }
}

}  // namespace cell
