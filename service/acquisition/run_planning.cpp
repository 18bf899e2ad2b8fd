// Each co_await stands alone in its statement, see cs8_controller.cpp.
#include "service/acquisition/run_planning.hpp"

#include <utility>

#include "service/acquisition/touch_judgement.hpp"
#include "service/run/planning_problem.hpp"

namespace cell {

namespace asio = boost::asio;
using namespace std::chrono_literals;

PlanGiven given_to(const Run& run) {
  return {.block_temperature = run.block_temperature(),
          .stiffness = run.recipe().identification.stiffness,
          .verification = run.verification()};
}

RunPlanning::RunPlanning(const Cell& cell, const std::optional<BlockPose>& place, StoreQueue& store,
                         PlanCache& plans, TouchPreparation& preparation, PublishedStatus& status, Wake& wake)
    : cell_(cell),
      place_(place),
      store_(store),
      plans_(plans),
      preparation_(preparation),
      status_(status),
      wake_(wake) {}

asio::awaitable<bool> RunPlanning::wait_for_outcome(const Run& run) {
  const std::string recipe = run.recipe().name;
  const PlanGiven given = given_to(run);
  const State state = status_.state();
  if (!plans_.planned(recipe, given)) plans_.begin(recipe, given, [&wake = wake_] { wake.wake(); });
  while (!plans_.planned(recipe, given) && status_.state() == state) co_await wake_.wait(1h);
  const bool goes_on = status_.state() == state;
  if (!goes_on) plans_.cancel();
  co_return goes_on;
}

asio::awaitable<bool> RunPlanning::plan(ActiveRun& active) {
  const bool goes_on = co_await wait_for_outcome(active.run);
  if (!goes_on) co_return false;
  const PlanOutcome outcome = *plans_.planned(active.run.recipe().name, given_to(active.run));
  if (const auto* refusal = std::get_if<PlanRefusal>(&outcome)) {
    status_.raise({FaultCode::kRecipeUnreachable, refusal->message}, Event::kAbortFault);
    co_return false;
  }
  const auto plan = std::get<std::shared_ptr<const Plan>>(outcome);
  const bool adopted = co_await adopt(active, plan);
  co_return adopted;
}

asio::awaitable<bool> RunPlanning::adopt(ActiveRun& active, std::shared_ptr<const Plan> plan) {
  if (const auto invalid = plan_fault(plan->touches.touches)) {
    status_.raise(*invalid, Event::kAbortFault);
    co_return false;
  }
  const int total = static_cast<int>(plan->touches.touches.size());
  std::vector<PlanChange> changes;
  if (active.block_is_away) changes.push_back({PlanChange::Kind::kBlockToMove, 0});
  const auto write = [id = active.run.id(), total, plan, changes](RunStore& store) {
    store.set_plan(id, total, plan->id, plan->document, changes);
  };
  const auto failure = co_await store_.write(write);
  if (failure) {  // it has no plan: it is planned and stored anew when a person lets it go on
    status_.raise({FaultCode::kStoreFailed, *failure}, Event::kHoldFault);
    co_return false;
  }
  active.run.set_plan(plan->touches);
  for (const PlanChange& change : changes) active.run.change_plan(change);
  active.stored_changes = active.run.plan_changes().size();
  begin_touches(active);
  status_.publish();
  co_return true;
}

void RunPlanning::begin_touches(ActiveRun& active) {
  const Cell cell = cell_with(cell_, given_to(active.run));
  preparation_.begin(planning_problem(cell, active.run.recipe(), active.run.place()));
  active.place_check.reset();
  if (active.run.place() != 0) return;  // the touches that found the place are at the first one
  if (!place_ || active.run.kind() == RunKind::kTool) return;  // the probe found the place, not the tool
  // The check knows the touches that found the place, so the place's uncertainty is none of its own: with it,
  // a block that was moved by as much would pass.
  calib::PlanningProblem of_arm = preparation_.problem();
  of_arm.nominal_position_error_m = cell_.nominal_position_error_m;
  active.place_check.emplace(std::move(of_arm), *place_);
}

}  // namespace cell
