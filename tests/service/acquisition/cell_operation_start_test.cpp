// What a start makes of a store in which the row of an earlier run is damaged.
#include <SQLiteCpp/SQLiteCpp.h>
#include <gmock/gmock.h>

#include "service/documents/block_pose_file.hpp"
#include "tests/service/acquisition/operation_bench.hpp"

namespace cell {
namespace {

/// An operation that is ready to start.
class StartBehindADamagedRun : public ::testing::Test, protected OperationBench {
 protected:
  std::variant<Started, CommandRefusal> start() { return OperationBench::start({.recipe = "few"}); }
  std::int64_t end_a_run() {
    const std::int64_t id = store_.begin_run({.recipe = "few", .started_at = "start"});
    store_.finish_run(id,
                      {.outcome = RunOutcome::kComplete, .verdict = Verdict::kRejected, .ended_at = "end"});
    return id;
  }
  void damage(std::int64_t run) {
    store_.database()->exec("UPDATE runs SET trace_json = 'x' WHERE id = " + std::to_string(run));
  }
};

TEST_F(StartBehindADamagedRun, IsRefusedWhereNobodyCanTellWhetherThatRunHadAPlace) {
  damage(end_a_run());
  launch();
  const auto answer = start();
  ASSERT_TRUE(std::holds_alternative<CommandRefusal>(answer));
  const auto& refusal = std::get<CommandRefusal>(answer);
  ASSERT_EQ(refusal.unmet.size(), 1U);
  EXPECT_EQ(refusal.unmet[0].code, "place_lost");
  EXPECT_THAT(refusal.unmet[0].detail, ::testing::AllOf(::testing::HasSubstr("table runs, run 1"),
                                                        ::testing::HasSubstr("touchcal locate")));
}

TEST_F(StartBehindADamagedRun, IsNotAnExitWhereThePlaceIsLostAndNotReady) {
  damage(end_a_run());
  operation_.keep_place_in(folder_.path() / "place.json");
  launch();
  EXPECT_EQ(operation_.status().state, State::kIdle);
  EXPECT_THAT(operation_.exits(), ::testing::Not(::testing::Contains(Command::kStart)));
  EXPECT_EQ(operation_.unmet_before_start().at(0).code, "place_lost");
  EXPECT_TRUE(operation_.unmet_preconditions().empty()) << "the block can be located";
}

TEST_F(StartBehindADamagedRun, GoesOnWhereAPlaceIsLoaded) {
  damage(end_a_run());
  const std::filesystem::path place = folder_.path() / "place.json";
  BlockPose found{.cell_from_block = Eigen::Isometry3d::Identity(),
                  .covariance = 1e-8 * Eigen::Matrix<double, 6, 6>::Identity(),
                  .std_block_pose = {},
                  .touches = {},
                  .located_at = "2026-11-22T03:00:00.000Z",
                  .digest = block_pose_digest(cell_of_owners())};
  for (const calib::PlannedTouch& touch : plan_of_owners().touches.touches)
    if (found.touches.size() < 6) found.touches.push_back({touch.face, touch.joints, 1e-4});
  write_block_pose(place, found);
  operation_.keep_place_in(place);
  ASSERT_TRUE(operation_.place());
  launch();
  EXPECT_TRUE(std::holds_alternative<Started>(start()));
}

TEST_F(StartBehindADamagedRun, GoesOnWhereItIsNotTheLastOne) {
  damage(end_a_run());
  end_a_run();
  launch();
  EXPECT_TRUE(std::holds_alternative<Started>(start()));
}

}  // namespace
}  // namespace cell
