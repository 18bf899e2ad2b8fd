// What stands in the way of a start, and what a refusal leaves as it was.
#include <SQLiteCpp/SQLiteCpp.h>
#include <gmock/gmock.h>

#include "service/documents/block_pose_file.hpp"
#include "service/run/touch_command.hpp"
#include "tests/service/acquisition/block_location_bench.hpp"
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

Cell with_temperature(std::optional<double> celsius,
                      std::optional<std::chrono::system_clock::time_point> at) {
  Cell cell = cell_of_owners();
  cell.block.temperature_c = celsius;
  cell.block.temperature_at = at;
  return cell;
}

class TemperatureOfTheBlock : public ::testing::Test {
 protected:
  struct Operation : OperationBench {
    explicit Operation(const Cell& cell) : OperationBench(nullptr, cell) { launch(); }
    using OperationBench::operation_;
    using OperationBench::start;
  };
  static void expect_told_and_brought(const Cell& cell, const std::string& code) {
    Operation of(cell);
    EXPECT_EQ(of.operation_.status().state, State::kIdle);
    EXPECT_THAT(of.operation_.exits(), ::testing::Not(::testing::Contains(Command::kStart)));
    ASSERT_EQ(of.operation_.unmet_before_start().size(), 1U);
    EXPECT_EQ(of.operation_.unmet_before_start()[0].code, code);
    EXPECT_TRUE(of.operation_.unmet_preconditions().empty()) << "the arm may move";
    const auto refused = of.start({.recipe = "few"});
    ASSERT_TRUE(std::holds_alternative<CommandRefusal>(refused));
    EXPECT_EQ(std::get<CommandRefusal>(refused).unmet.at(0).code, code);
    EXPECT_TRUE(std::holds_alternative<Started>(
        of.start({.recipe = "few", .block_temperature = BlockTemperature{.celsius = 21.0, .std_k = 0.5}})));
  }
};

TEST_F(TemperatureOfTheBlock, ThatIsMissingIsToldBeforeAStartAndAStartMayBringIt) {
  expect_told_and_brought(with_temperature(std::nullopt, std::nullopt), "temperature_missing");
}

TEST_F(TemperatureOfTheBlock, ThatIsTooOldIsToldBeforeAStartAndAStartMayBringIt) {
  const auto long_ago = std::chrono::system_clock::time_point{} - std::chrono::hours(1000);
  expect_told_and_brought(with_temperature(20.0, long_ago), "temperature_old");
}

/// A block that the arm cannot go around.
class CrampedBlock : public ::testing::Test, protected OperationBench {
 protected:
  CrampedBlock() : OperationBench(nullptr, cramped_cell()) {}
  void touch_by_hand(const calib::JointVector& joints) {
    cs8::State& state = controller_->state.value();
    const std::uint32_t free = state.flags;
    state.joints = to_wire(joints);
    tell_state();
    state.flags = (free | cs8::kProbeTouched) & ~static_cast<std::uint32_t>(cs8::kProbeLoopClosed);
    tell_state();
    state.flags = free;
    tell_state();
  }
};

TEST_F(CrampedBlock, LeavesTheLastRunAsItWasWhereThePassAroundItIsRefused) {
  launch();
  const std::int64_t id = std::get<Started>(start({.recipe = "few"})).run.id;
  ASSERT_FALSE(operation_.command(Command::kStop));
  run_until([this] { return operation_.status().state == State::kStopped; });
  ASSERT_FALSE(operation_.command(Command::kLocate));
  for (const PlaceSpot& spot : place_spots(cell_)) touch_by_hand(at(spot));
  ASSERT_EQ(operation_.status().by_hand.value().step, HandStep::kPass);
  const auto refused = operation_.command(Command::kLocate);
  ASSERT_TRUE(refused);
  EXPECT_THAT(refused->detail, ::testing::HasSubstr("leaves no room to pass it"));
  EXPECT_EQ(operation_.status().state, State::kStopped);
  EXPECT_EQ(operation_.status().run_id, id);
  EXPECT_TRUE(operation_.run());
}

class StartUnderALock : public ::testing::Test, protected OperationBench {};

TEST_F(StartUnderALock, IsHeldWithItsFaultAndGoesOnByResumeOnceTheLockIsGone) {
  launch();
  ASSERT_TRUE(std::holds_alternative<Started>(start({.recipe = "few"})));
  SQLite::Database other((folder_.path() / "touchcal.sqlite").string(), SQLite::OPEN_READWRITE);
  other.exec("BEGIN IMMEDIATE");
  run_until([&] { return operation_.status().state == State::kHeld; });
  EXPECT_EQ(operation_.status().fault.value().code, FaultCode::kStoreFailed);
  EXPECT_GE(time_.since_begin(), kLockPatience);
  EXPECT_THAT(operation_.exits(), ::testing::IsSupersetOf({Command::kResume, Command::kStop}));
  other.exec("ROLLBACK");
  controller_->on_touch = [](const cs8::Touch&) {
    cs8::TouchResult nothing;
    nothing.outcome = cs8::Outcome::kNoContact;
    return nothing;
  };
  EXPECT_FALSE(operation_.command(Command::kResume));
  run_until([&] { return operation_.status().state == State::kHeld; });
  EXPECT_EQ(operation_.status().fault.value().code, FaultCode::kNoContact) << "it has its plan and moves";
  EXPECT_TRUE(store_.run(operation_.run()->id()).value().plan_id);
}

}  // namespace
}  // namespace cell
