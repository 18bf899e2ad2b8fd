#include "service/acquisition/block_move.hpp"

#include <gmock/gmock.h>
#include <sqlite3.h>

#include "service/run/planning_problem.hpp"
#include "tests/service/acquisition/executor_bench.hpp"

namespace cell {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using Kind = PlanChange::Kind;

/// Two touches at each place.
calib::TouchPlan short_plan() {
  static const Plan plan = [] {
    const TipRegions regions(cell_of_owners());
    return std::get<Plan>(make_plan(regions, cell_of_owners().recipes.at("two places")));
  }();
  calib::TouchPlan few = plan.touches;
  const auto second = few.touches.begin() + static_cast<std::ptrdiff_t>(few.leaving.at(0).touches);
  few.touches = {few.touches[0], few.touches[1], second[0], second[1]};
  return few;
}

class BlockMoveTest : public ExecutorBench {
 protected:
  BlockMoveTest() {
    two_.run.set_plan(short_plan());
    preparation.begin(planning_problem(cell_of_owners(), two_.run.recipe()));
    touches_.begin_run(two_);
  }

  void touch() { run(touches_.make_next_touch(two_)); }
  /// What a person's resume does in the cell's loop.
  bool resume() {
    touches_.settle_hold(two_, Command::kResume);
    const bool stored = run(touches_.store_answer(two_));
    const bool moved = touches_.take_moved_block();
    if (moved) preparation.forget_made();
    if (moved) preparation.begin(planning_problem(cell_of_owners(), two_.run.recipe(), two_.run.place()));
    status.clear_fault();
    status.enter(State::kExecute);
    return stored && moved;
  }
  [[nodiscard]] std::string fault() const {
    return status.fault() ? std::string(describe(status.fault()->code).name) : "";
  }

  ActiveRun two_ = begun_run("two places");
};

TEST_F(BlockMoveTest, AsksForTheBlockWhenNoTouchIsLeftWhereItStands) {
  touch();
  touch();
  EXPECT_EQ(two_.run.touches_done(), 2);
  EXPECT_FALSE(two_.run.next_here());
  controller.asked.clear();
  touch();
  EXPECT_THAT(controller.asked, ElementsAre(HasSubstr("travel"), HasSubstr("acknowledge")))
      << "to the park posture, and nothing else";
  EXPECT_EQ(fault(), "block_to_move");
  EXPECT_EQ(status.state(), State::kHolding);
  EXPECT_THAT(status.fault()->message(), HasSubstr("\"aside\""));
  EXPECT_EQ(touches_.held_by(), HeldBy::kBlock);
  EXPECT_EQ(two_.run.moving_to(), 1);
  const auto changes = store.plan_changes(two_.run.id());
  ASSERT_EQ(changes.size(), 1u);
  EXPECT_EQ(changes[0].kind, Kind::kBlockToMove) << "stored before anybody touches the block";
}

TEST_F(BlockMoveTest, GoesOnAtTheNewPlaceAfterAPersonsWord) {
  touch();
  touch();
  touch();
  status.enter(State::kHeld);
  EXPECT_TRUE(resume());
  EXPECT_EQ(two_.run.place(), 1);
  EXPECT_EQ(store.plan_changes(two_.run.id()).back().kind, Kind::kBlockMoved);
  touch();
  touch();
  EXPECT_EQ(two_.run.touches_done(), 4);
  const int faces = static_cast<int>(cell_of_owners().block.faces.size());
  EXPECT_GT(store.touches(two_.run.id()).back().plane, faces);
  touch();
  EXPECT_EQ(status.state(), State::kCompleting);
}

TEST_F(BlockMoveTest, WhileTheBlockIsOnItsWayNothingMovesHoweverOftenTheRunGoesOn) {
  two_.run.change_plan({Kind::kBlockToMove, 1});  // as after a restart
  touches_.look_at_reference();
  touch();
  EXPECT_THAT(controller.asked, IsEmpty());
  EXPECT_EQ(fault(), "block_to_move");
  EXPECT_THAT(store.plan_changes(two_.run.id()), IsEmpty()) << "it was stored then";
}

TEST_F(BlockMoveTest, NobodyIsAskedWhereThatCannotBeStored) {
  touch();
  touch();
  controller.asked.clear();
  break_store();
  touch();
  mend_store();
  EXPECT_EQ(fault(), "store_failed");
  EXPECT_FALSE(two_.run.moving_to());
  EXPECT_EQ(touches_.held_by(), HeldBy::kNothing);
}

TEST_F(BlockMoveTest, AWordThatCannotBeStoredDoesNotCount) {
  touch();
  touch();
  touch();
  status.enter(State::kHeld);
  break_store();
  EXPECT_FALSE(resume());
  mend_store();
  EXPECT_EQ(two_.run.place(), 0);
  EXPECT_EQ(two_.run.moving_to(), 1);
  touch();
  EXPECT_EQ(fault(), "block_to_move");
  EXPECT_TRUE(resume());
}

TEST(BlockAway, TheLastWordCounts) {
  EXPECT_FALSE(is_block_away({}));
  EXPECT_FALSE(is_block_away({{Kind::kSkip, 3}}));
  EXPECT_EQ(is_block_away({{Kind::kBlockToMove, 1}}), true);
  EXPECT_EQ(is_block_away({{Kind::kBlockToMove, 1}, {Kind::kBlockMoved, 1}, {Kind::kDefer, 3}}), true);
  EXPECT_EQ(is_block_away({{Kind::kBlockMoved, 1}, {Kind::kBlockToMove, 0}}), true);
  EXPECT_EQ(is_block_away({{Kind::kBlockToMove, 0}, {Kind::kBlockMoved, 0}}), false);
}

}  // namespace
}  // namespace cell
