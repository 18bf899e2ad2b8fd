// A person finds the block by touching it, and runs go on from there.
#include "service/acquisition/locating.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "calib_core/geometry/units.hpp"
#include "config/moved_cell.hpp"
#include "service/documents/place_search.hpp"
#include "tests/end_to_end/block_elsewhere.hpp"

namespace touchcal::testing {
namespace {

using cell::Command;
using cell::State;

/// 40 mm off, turned by 5 degrees.
Eigen::Isometry3d moved_block() {
  return Eigen::Translation3d(0.032, 0.0, 0.024) *
         Eigen::AngleAxisd(calib::radians_from_degrees(5.0), Eigen::Vector3d::UnitY());
}

TEST_F(BlockElsewhere, IsFoundBySixTouchesAndCalibratesTheArmThere) {
  serve_block_at(moved_block());
  launch();
  locate_by_hand();
  EXPECT_FALSE(loop_.operation().place());  // not before the pass
  go_around();
  ASSERT_EQ(loop_.status().state, State::kIdle) << loop_.fault_name();
  EXPECT_FALSE(loop_.status().by_hand);
  ASSERT_TRUE(loop_.operation().place());

  const cell::BlockPose& place = *loop_.operation().place();
  const Eigen::Isometry3d off = moved_block().inverse() * place.cell_from_block;
  for (int axis = 0; axis < 3; ++axis) {
    EXPECT_LT(std::abs(off.translation()[axis]), 3.0 * std::sqrt(place.covariance(axis, axis))) << axis;
  }
  EXPECT_LT(off.translation().norm(), loop_.cell.nominal_position_error_m);

  loop_.relaunch();  // the next daemon knows it
  ASSERT_TRUE(loop_.operation().place());
  loop_.run_until(State::kIdle);
  const std::int64_t id = loop_.start();
  loop_.run_until_over();
  ASSERT_EQ(loop_.status().state, State::kComplete) << loop_.fault_name();
  EXPECT_EQ(loop_.status().touches_done, kShortTouchCount);
  const calib::IdentificationResult& result = loop_.operation().run()->latest();
  ASSERT_EQ(result.status, calib::IdentificationStatus::kConverged) << result.message;
  EXPECT_EQ(result.identifiable.columns.size(), static_cast<std::size_t>(kRank));
  EXPECT_NE(loop_.store().run(id)->conditions_json->find("shift_mm"), std::string::npos);
}

class DemoBlockElsewhere : public BlockElsewhere {
 protected:
  DemoBlockElsewhere() : BlockElsewhere("demo") {}
};

TEST_F(DemoBlockElsewhere, IsRunAtWithPathsAsWideAsItsPlaceIsUncertain) {
  serve_block_at(moved_block());
  launch();
  locate_by_hand();
  go_around();
  ASSERT_TRUE(loop_.operation().place()) << loop_.fault_name();
  const double error_m = loop_.operation().cell().face_error_m();
  EXPECT_GT(error_m, loop_.cell.nominal_position_error_m) << "else this cell shows nothing";
  loop_.run_until(State::kIdle);
  loop_.start();
  loop_.run_until_over();
  ASSERT_EQ(loop_.status().state, State::kComplete) << loop_.fault_name();
  EXPECT_EQ(loop_.status().touches_done, kShortTouchCount);
  EXPECT_EQ(loop_.operation().run()->planned(0)->predicted_position_error_m, error_m);
}

TEST_F(BlockElsewhere, ATouchTakenBackIsMadeAgainAndTheDialogueCanBeLeft) {
  serve_block_at(moved_block());
  launch();
  for (const Command command : {Command::kTake, Command::kUndo}) EXPECT_TRUE(loop_.is_refused(command));
  loop_.command(Command::kLocate);
  for (const Command command : {Command::kTake, Command::kUndo})
    EXPECT_TRUE(loop_.is_refused(command));  // the probe is free, and nothing was touched yet
  Pendant pendant(loop_, there_, plant_);
  pendant.take_over();
  const auto spots = cell::place_spots(loop_.cell);
  touch(pendant, spots[0]);
  EXPECT_EQ(loop_.status().by_hand->index, 2);
  loop_.inject(R"({"fault":"close"})");
  loop_.run_until([](const cell::Status& status) { return !status.controller.connected; });
  loop_.run_until([](const cell::Status& status) { return status.controller.connected; });
  EXPECT_EQ(loop_.status().by_hand->index, 2) << "a lost link takes no touch";
  loop_.command(Command::kLocate);  // once more changes nothing
  EXPECT_EQ(loop_.status().by_hand->index, 2);
  loop_.command(Command::kUndo);
  loop_.run_until([](const cell::Status& status) { return status.by_hand.value().index == 1; });
  loop_.relaunch();  // without a touch there is nothing to keep
  EXPECT_FALSE(loop_.status().by_hand);
  loop_.run_until([](const cell::Status& status) { return status.controller.connected; });
  loop_.command(Command::kLocate);
  ASSERT_TRUE(loop_.status().by_hand);
  loop_.command(Command::kStop);
  EXPECT_FALSE(loop_.status().by_hand);
  EXPECT_FALSE(std::filesystem::exists(loop_.place_file));
}

TEST_F(BlockElsewhere, ADialogueKeepsItsTouchesOverDaemonsALostLinkAndAnEmergencyStop) {
  serve_block_at(moved_block());
  launch();
  loop_.command(Command::kLocate);
  Pendant pendant(loop_, there_, plant_);
  pendant.take_over();
  const auto spots = cell::place_spots(loop_.cell);
  for (std::size_t i = 0; i < spots.size(); ++i) {
    SCOPED_TRACE("touch " + std::to_string(i + 1));
    touch(pendant, spots[i]);
    const int behind = loop_.status().by_hand.value().index;
    EXPECT_EQ(behind, static_cast<int>(std::min(i + 2, spots.size())));
    if (i == 1) loop_.inject(R"({"fault":"close"})");
    if (i == 1) loop_.run_until([](const cell::Status& status) { return !status.controller.connected; });
    if (i == 2) loop_.inject(R"({"fault":"emergency_stop"})");
    if (i == 2)
      loop_.run_until(
          [](const cell::Status& status) { return status.controller.emergency_stop.value_or(false); });
    loop_.relaunch();
    ASSERT_TRUE(loop_.status().by_hand);
    EXPECT_EQ(loop_.status().by_hand->index, behind);
    EXPECT_NE(loop_.status().by_hand->words.find(" kept"), std::string::npos);
    loop_.run_until([](const cell::Status& status) { return status.controller.connected; });
    if (i == 2) loop_.inject(R"({"fault":"release_emergency_stop"})");
    if (i == 2) loop_.inject(R"({"fault":"acknowledge_emergency_stop"})");
    if (i == 2) pendant.take_over();
  }
  pendant.hand_back();
  loop_.run_until(State::kIdle);
  loop_.command(Command::kLocate);
  ASSERT_EQ(loop_.status().by_hand.value().step, cell::HandStep::kPassing);
  loop_.inject(R"({"fault":"close"})");
  loop_.run_until([](const cell::Status& status) { return !cell::is_active(status.state); });
  ASSERT_EQ(loop_.status().state, State::kAborted);
  loop_.leave_aborted();
  EXPECT_EQ(loop_.status().by_hand.value().step, cell::HandStep::kPass) << "the touches are there";
  go_around();
  ASSERT_TRUE(loop_.operation().place()) << loop_.fault_name();
  const Eigen::Isometry3d off = moved_block().inverse() * loop_.operation().place()->cell_from_block;
  EXPECT_LT(off.translation().norm(), loop_.cell.nominal_position_error_m);
  loop_.relaunch();
  EXPECT_FALSE(loop_.status().by_hand) << "it is over";
}

TEST_F(BlockElsewhere, ATouchOnTheWayAroundTheBlockEndsTheDialogueWithoutAPlace) {
  serve_block_at(moved_block());
  launch();
  locate_by_hand();
  move_block(Eigen::Translation3d(0.0, -0.06, 0.0) * moved_block());  // up, into the way
  EXPECT_EQ(loop_.status().by_hand->step, cell::HandStep::kPass);
  go_around();
  EXPECT_EQ(loop_.status().state, State::kAborted);
  EXPECT_EQ(loop_.fault_name(), "unexpected_contact");
  EXPECT_FALSE(loop_.status().by_hand);
  EXPECT_FALSE(loop_.operation().place());
  EXPECT_FALSE(std::filesystem::exists(loop_.place_file));
}

TEST_F(BlockElsewhere, ARunOnAnOldPlaceIsHeldByItsFirstTouches) {
  serve_block_at(moved_block());
  launch();
  locate_by_hand();
  go_around();
  ASSERT_TRUE(loop_.operation().place()) << loop_.fault_name();
  move_block(Eigen::Translation3d(0.02, 0.0, 0.0) * moved_block());
  loop_.start();
  loop_.run_until_over();
  EXPECT_EQ(loop_.fault_name(), "block_moved");
  const std::vector<cell::StoredTouch>& made = loop_.operation().run()->touches();
  ASSERT_FALSE(made.empty());
  const auto is_of_last_face = [&](const cell::StoredTouch& touch) {
    return touch.plane == made.back().plane;
  };
  EXPECT_EQ(std::ranges::count_if(made, is_of_last_face), 1) << "the first on a face that is elsewhere";
  EXPECT_LE(made.size(), 2U * kPlaneCount);
}

}  // namespace
}  // namespace touchcal::testing
