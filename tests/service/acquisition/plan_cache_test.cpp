#include "service/acquisition/plan_cache.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/service/acquisition/owners_bench.hpp"

namespace cell {
namespace {

class PlanCacheTest : public ::testing::Test, public OwnersBench {
 protected:
  PlanCache plans_{io.get_executor(), io.get_executor(), cell_of_owners()};
};

TEST_F(PlanCacheTest, PlansARecipeOnceAndGivesItAgain) {
  EXPECT_FALSE(plans_.planned("few"));
  const auto first = std::get<std::shared_ptr<const Plan>>(run(plans_.plan("few")));
  const auto again = std::get<std::shared_ptr<const Plan>>(run(plans_.plan("few")));
  EXPECT_EQ(first, again);
  EXPECT_EQ(first->id, plan_of_owners().id) << "planning is deterministic";
  EXPECT_EQ(plans_.plan_with_id(first->id), first);
  EXPECT_EQ(plans_.plan_with_id("another"), nullptr);
  EXPECT_FALSE(plans_.is_planning());
}

TEST_F(PlanCacheTest, APlanThatIsHandedInIsNotMadeAgain) {
  auto made = std::make_shared<Plan>(plan_of_owners());
  made->id = "made elsewhere";
  plans_.hand_in(made);
  EXPECT_EQ(std::get<std::shared_ptr<const Plan>>(run(plans_.plan("few"))), made);
  EXPECT_EQ(plans_.plan_with_id("made elsewhere"), made);
  EXPECT_TRUE(plans_.planned("few", {{}, cell_of_owners().recipes.at("few").identification.stiffness}));
}

/// Plans are made when the test lets the planner.
class PlannerOfItsOwn : public PlanCacheTest {
 protected:
  void begin() {
    plans_.begin("few", {}, [this] { is_done_ = true; });
    io.restart();
    io.poll();
    EXPECT_TRUE(plans_.is_planning());
  }
  void let_plan() {
    planner_.restart();
    EXPECT_EQ(planner_.run(), 1u);
    io.restart();
    io.poll();
  }

  boost::asio::io_context planner_{1};
  PlanCache plans_{io.get_executor(), planner_.get_executor(), cell_of_owners()};
  bool is_done_ = false;
};

TEST_F(PlannerOfItsOwn, IsTheOnlyOneThatPlans) {
  begin();
  EXPECT_FALSE(is_done_ || plans_.planned("few"));
  let_plan();
  EXPECT_TRUE(is_done_ && plans_.planned("few"));
}

TEST_F(PlannerOfItsOwn, MakesAPlanAgainThatWasBegunBeforeTheBlockStoodElsewhere) {
  begin();
  plans_.clear();
  let_plan();
  EXPECT_FALSE(is_done_);
  let_plan();
  EXPECT_TRUE(is_done_);
  EXPECT_TRUE(plans_.planned("few"));
  plans_.clear();
  EXPECT_FALSE(plans_.planned("few"));
}

/// A start waited half a minute for a plan that somebody had asked to see.
TEST_F(PlannerOfItsOwn, GivesUpAPlanThatIsOnlyLookedAtForThatOfARun) {
  std::optional<PlanOutcome> looked_at;
  boost::asio::co_spawn(io.get_executor(), plans_.plan("few"),
                        [&looked_at](auto&&, PlanOutcome made) { looked_at = std::move(made); });
  begin();
  EXPECT_EQ(planner_.run_one(), 1u);
  io.restart();
  io.poll();
  ASSERT_TRUE(looked_at);
  EXPECT_THAT(std::get<PlanRefusal>(*looked_at).message, ::testing::HasSubstr("nobody waits for this plan"));
  EXPECT_FALSE(is_done_ || plans_.planned("few"));
  let_plan();
  EXPECT_TRUE(is_done_ && plans_.planned("few"));
}

TEST_F(PlannerOfItsOwn, MakesNoPlanAtTheEnd) {
  begin();
  plans_.end();
  let_plan();
  EXPECT_TRUE(is_done_);
  EXPECT_FALSE(plans_.planned("few") || plans_.is_planning());
}

TEST_F(PlanCacheTest, APlanThatIsGivenUpIsNeitherMadeNorRefusedTheNextTime) {
  bool done = false;
  plans_.begin("few", {}, [&done] { done = true; });
  plans_.cancel();
  io.restart();
  io.run();
  EXPECT_TRUE(done);
  EXPECT_FALSE(plans_.planned("few"));
  EXPECT_FALSE(plans_.is_planning());
  EXPECT_EQ(std::get<std::shared_ptr<const Plan>>(run(plans_.plan("few")))->id, plan_of_owners().id);
}

TEST_F(PlanCacheTest, ATemperatureThatIsGivenHasItsOwnPlanAndTheLatestOneIsKept) {
  const auto id_at = [this](const BlockTemperature& given) {
    return std::get<std::shared_ptr<const Plan>>(run(plans_.plan("few", {given, {}})))->id;
  };
  const BlockTemperature warm{.celsius = 25.0, .std_k = 2.0}, warmer{.celsius = 30.0, .std_k = 2.0};
  EXPECT_EQ(id_at({*edf().block.temperature_c, edf().block.std_temperature_k, {}}), plan_of_owners().id)
      << "the cell's own is not planned again";
  const std::string id = id_at(warm);
  EXPECT_NE(id, plan_of_owners().id);
  EXPECT_EQ(plans_.plan_with_id(id), nullptr) << "it is for that run alone";
  EXPECT_TRUE(plans_.planned("few", {warm, {}}));
  EXPECT_TRUE(
      plans_.planned("few", {BlockTemperature{25.0, 2.0, std::chrono::system_clock::time_point{}}, {}}));
  EXPECT_NE(id_at(warmer), id);
  EXPECT_FALSE(plans_.planned("few", {warm, {}}));
  EXPECT_TRUE(plans_.planned("few"));
}

TEST_F(PlanCacheTest, AChoiceOfStiffnessThatIsNotTheRecipesHasItsOwnPlan) {
  const bool of_recipe = cell_of_owners().recipes.at("few").identification.stiffness;
  const auto id_with = [this](bool stiffness) {
    return std::get<std::shared_ptr<const Plan>>(run(plans_.plan("few", {{}, stiffness})))->id;
  };
  EXPECT_EQ(id_with(of_recipe), plan_of_owners().id) << "the recipe's own is not planned again";
  const std::string id = id_with(!of_recipe);
  EXPECT_NE(id, plan_of_owners().id);
  EXPECT_EQ(plans_.plan_with_id(id), nullptr) << "it is for that run alone";
  EXPECT_TRUE(plans_.planned("few", {{}, !of_recipe}));
  EXPECT_TRUE(plans_.planned("few"));
}

}  // namespace
}  // namespace cell
