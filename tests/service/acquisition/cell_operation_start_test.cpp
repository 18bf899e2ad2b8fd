// What a start makes of a store in which the row of an earlier run is damaged.
#include <SQLiteCpp/SQLiteCpp.h>
#include <gmock/gmock.h>
#include <spdlog/spdlog.h>

#include <boost/asio/co_spawn.hpp>

#include "service/acquisition/cell_operation.hpp"
#include "service/documents/block_pose_file.hpp"
#include "tests/service/acquisition/owners_bench.hpp"

namespace cell {
namespace {

/// An operation that is ready to start.
class StartBehindADamagedRun : public ::testing::Test {
 protected:
  StartBehindADamagedRun() { spdlog::set_level(spdlog::level::off); }
  ~StartBehindADamagedRun() override {
    controller_->is_connected = false;  // nobody whose answer the end waits for
    bool down = false;
    boost::asio::co_spawn(io_, operation_.shut_down(), [&](const std::exception_ptr&) { down = true; });
    io_.restart();
    while (!down) io_.run_one();
  }
  void launch() {
    operation_.launch();
    io_.poll();
    controller_->hooks.on_state(controller_->state.value());
    io_.restart();
    io_.poll();
  }
  std::variant<Started, CommandRefusal> start() {
    std::optional<std::variant<Started, CommandRefusal>> answer;
    boost::asio::co_spawn(io_, operation_.start({.recipe = "few"}),
                          [&](const std::exception_ptr&, const std::variant<Started, CommandRefusal>& given) {
                            answer = given;
                          });
    io_.restart();
    while (!answer) io_.run_one();
    return *answer;
  }
  std::int64_t end_a_run() {
    const std::int64_t id = store_.begin_run({.recipe = "few", .started_at = "start"});
    store_.finish_run(id,
                      {.outcome = RunOutcome::kComplete, .verdict = Verdict::kRejected, .ended_at = "end"});
    return id;
  }
  void damage(std::int64_t run) {
    store_.database()->exec("UPDATE runs SET trace_json = 'x' WHERE id = " + std::to_string(run));
  }

  Folder folder_;
  RunStore store_{folder_.path() / "touchcal.sqlite"};
  boost::asio::io_context io_{1};
  MadeUpTime time_;
  ScriptedController* controller_ = new ScriptedController;  // the operation's
  CellOperation operation_{
      {io_.get_executor(), io_.get_executor()}, cell_of_owners(), StoreQueue(store_, io_.get_executor()),
      std::unique_ptr<Controller>(controller_), "instance",       time_.clocks()};
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
