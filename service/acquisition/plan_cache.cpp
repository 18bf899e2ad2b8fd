// Each co_await stands alone in its statement, see cs8_controller.cpp.
#include "service/acquisition/plan_cache.hpp"

#include <boost/asio/co_spawn.hpp>
#include <exception>
#include <string_view>

#include "config/mounted_tool.hpp"
#include "service/base/run_on.hpp"

namespace cell {

namespace asio = boost::asio;

namespace {

/// What leaves the planner when nobody wants its plan any more.
class GivenUp : public std::exception {
 public:
  [[nodiscard]] const char* what() const noexcept override { return "nobody waits for this plan any more"; }
};

/// On the planner's thread. `goes_on` is called now and then.
PlanOutcome make_outcome(const Cell& cell, const Recipe& recipe, const Verification* verification,
                         const std::function<bool()>& goes_on) {
  const auto end_unless_wanted = [&goes_on](std::string_view, double) {
    if (!goes_on()) throw GivenUp();
  };
  try {
    end_unless_wanted({}, 0.0);
    const TipRegions regions(cell);  // those of the status are for the other thread
    auto made = verification ? make_verification_plan(regions, recipe, *verification)
                             : make_plan(regions, recipe, end_unless_wanted);
    if (auto* refusal = std::get_if<PlanRefusal>(&made)) return std::move(*refusal);
    return std::make_shared<const Plan>(std::get<Plan>(std::move(made)));
  } catch (const std::exception& error) {
    return PlanRefusal{.message = std::string("planning failed: ") + error.what(), .efforts = {}};
  }
}

}  // namespace

Cell cell_with(const Cell& cell, const PlanGiven& given) {
  Cell made = with_block_temperature(cell, given.block_temperature);
  if (!given.verification) return made;
  if (given.verification->kind == RunKind::kTool) return with_tool_mounted(made, given.verification->tool);
  return with_stand(made, *given.verification);
}

PlanCache::Key PlanCache::key_of(const std::string& recipe, const PlanGiven& given) const {
  Key key{.recipe = recipe};
  if (given.verification) {
    key.kind = given.verification->kind;
    key.of_run = given.verification->of_run;
    key.tool = given.verification->tool;
  }
  const Block& block = cell_.block;
  const auto& temperature = given.block_temperature;
  if (temperature &&
      (block.temperature_c != temperature->celsius || block.std_temperature_k != temperature->std_k)) {
    key.celsius = temperature->celsius;
    key.std_k = temperature->std_k;
  }
  const auto named = cell_.recipes.find(recipe);
  if (named == cell_.recipes.end() || given.stiffness != named->second.identification.stiffness)
    key.stiffness = given.stiffness;
  return key;
}

/// Nobody starts a run at an earlier temperature again.
void PlanCache::keep(const Key& key, const PlanOutcome& made) {
  if (!key.is_own()) {
    std::erase_if(
        plans_, [&key](const auto& plan) { return plan.first.recipe == key.recipe && !plan.first.is_own(); });
  }
  plans_.emplace(key, made);
}

asio::awaitable<PlanOutcome> PlanCache::plan(std::string recipe, PlanGiven given) {
  asked_ = std::make_shared<std::atomic<bool>>(false);
  return make(std::move(recipe), given, asked_);
}

asio::awaitable<PlanOutcome> PlanCache::make(std::string recipe, PlanGiven given, Flag cancelled) {
  const Key key = key_of(recipe, given);
  for (;;) {
    if (const auto made = plans_.find(key); made != plans_.end()) co_return made->second;
    // As it stands now.
    const auto cell = std::make_shared<const Cell>(cell_with(cell_, given));
    Recipe chosen = cell->recipes.at(recipe);
    if (given.stiffness) chosen.identification.stiffness = *given.stiffness;
    if (given.verification) chosen = verification_recipe(*cell, chosen, given.verification->kind);
    const int clear_count = clear_count_;
    ++under_way_count_;
    const auto plan = [cell, chosen, verification = given.verification, cancelled, ended = ended_] {
      return make_outcome(*cell, chosen, verification.get(), [&] { return !*ended && !*cancelled; });
    };
    const PlanOutcome made = co_await run_on(planner_, plan);
    --under_way_count_;
    if (*cancelled || *ended_) co_return made;
    if (clear_count == clear_count_) keep(key, made);
  }
}

void PlanCache::begin(std::string recipe, PlanGiven given, std::function<void()> done) {
  if (asked_) *asked_ = true;
  begun_ = std::make_shared<std::atomic<bool>>(false);
  asio::co_spawn(executor_, make(std::move(recipe), given, begun_),
                 [done = std::move(done)](auto&&...) { done(); });
}

void PlanCache::hand_in(std::shared_ptr<const Plan> plan) {
  const Key key =
      key_of(plan->recipe, {.stiffness = cell_.recipes.at(plan->recipe).identification.stiffness});
  plans_.insert_or_assign(key, PlanOutcome(std::move(plan)));
}

void PlanCache::cancel() {
  if (begun_) *begun_ = true;
}

std::optional<PlanOutcome> PlanCache::planned(const std::string& recipe, const PlanGiven& given) const {
  const auto found = plans_.find(key_of(recipe, given));
  return found == plans_.end() ? std::nullopt : std::optional(found->second);
}

std::shared_ptr<const Plan> PlanCache::plan_with_id(const std::string& id) const {
  for (const auto& [key, outcome] : plans_) {
    if (!key.is_own()) continue;
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
