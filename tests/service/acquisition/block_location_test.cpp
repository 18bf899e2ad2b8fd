#include "service/acquisition/block_location.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <boost/asio/co_spawn.hpp>
#include <exception>
#include <filesystem>
#include <optional>
#include <stdexcept>

#include "calib_core/kinematics/inverse_kinematics.hpp"
#include "calib_core/motion/transfer_path.hpp"
#include "service/acquisition/block_pass.hpp"
#include "service/run/touch_command.hpp"
#include "tests/service/acquisition/block_location_bench.hpp"

namespace cell {
namespace {

using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::StartsWith;

TEST_F(BlockLocationTest, WithoutALinkThereIsNoDialogue) {
  controller.is_connected = false;
  const auto refusal = location_.locate();
  EXPECT_EQ(refusal.value().kind, CommandRefusal::Kind::kPreconditions);
  EXPECT_FALSE(location_.is_locating());
}

TEST_F(BlockLocationTest, AsksForOneTouchAfterTheOtherAndTakesTheLastOneBack) {
  EXPECT_FALSE(location_.guide());
  ASSERT_FALSE(location_.locate());
  EXPECT_TRUE(location_.awaits_touch());
  EXPECT_FALSE(location_.can_undo());
  const PlaceSpot first = place_spots(cell_of_owners()).front();
  touch(at(first));
  EXPECT_EQ(location_.guide().value().index, 2);
  EXPECT_TRUE(location_.can_undo());
  location_.undo();
  settle();
  EXPECT_EQ(location_.guide().value().index, 1);
  location_.leave();
  EXPECT_FALSE(location_.guide());
}

TEST_F(BlockLocationTest, TakesATouchByWordOnlyWhenTheProbeTouches) {
  ASSERT_FALSE(location_.locate());
  location_.on_controller_state(ScriptedController::ready_state());
  EXPECT_NE(location_.take().value().detail.find("free"), std::string::npos);
}

TEST_F(BlockLocationTest, APlaceCountsOnceTheArmWentAroundTheBlockAndItIsStored) {
  const auto file = folder.path() / "place.json";
  EXPECT_FALSE(location_.keep_in(file)) << "there is none yet";
  const auto before = location_.located_cell();
  touch_all_spots();
  ASSERT_EQ(location_.guide().value().step, HandStep::kPass) << location_.guide()->words;
  EXPECT_FALSE(location_.place());
  ASSERT_FALSE(location_.locate());
  ASSERT_TRUE(location_.is_passing());
  EXPECT_EQ(location_.guide().value().step, HandStep::kPassing);
  status.enter(State::kStarting);
  EXPECT_TRUE(run(location_.pass())) << status.fault().value_or(Fault{}).message();
  EXPECT_THAT(controller.asked, Contains("begin 0"));
  EXPECT_THAT(controller.asked, Contains(StartsWith("travel")).Times(::testing::Gt(3)));
  EXPECT_THAT(controller.asked, Contains("finish"));
  EXPECT_THAT(controller.asked, Not(Contains(StartsWith("touch"))));
  EXPECT_TRUE(location_.place());
  EXPECT_TRUE(location_.located_cell()->place) << "so do other threads see it";
  EXPECT_FALSE(before->place) << "what one of them has already stays as it was";
  EXPECT_FALSE(location_.is_locating());
  BlockLocation next_daemon(io.get_executor(), io.get_executor(), cell_of_owners(), queue, session, status,
                            wake, time.clocks());
  EXPECT_TRUE(next_daemon.keep_in(file));
  EXPECT_TRUE(next_daemon.place());
}

TEST_F(BlockLocationTest, APlaceThatNoSearchOfTheControllerReachesIsRefusedWithTheRemedy) {
  const auto takes_searches_of = [&](std::int32_t length_dmm) {
    cs8::Welcome welcome;
    welcome.search_length_max_dmm = length_dmm;
    controller.on_connect = [welcome] { return welcome; };
    run(session.connect(false));
  };
  touch_all_spots();
  takes_searches_of(340'000);
  const std::string why = location_.locate().value().detail;
  EXPECT_THAT(why, StartsWith("these touches determine the block's place to 2"));
  EXPECT_THAT(why, HasSubstr("14 mm is the limit, as the controller searches over 34 mm: "));
  EXPECT_THAT(why, HasSubstr("touchcal undo"));
  EXPECT_FALSE(location_.is_passing());
  takes_searches_of(600'000);
  EXPECT_FALSE(location_.locate());
  EXPECT_TRUE(location_.is_passing());
}

TEST_F(BlockLocationTest, AnArmThatMeetsSomethingOnItsWayForgetsThePlace) {
  touch_all_spots();
  ASSERT_FALSE(location_.locate());
  ASSERT_TRUE(location_.is_passing());
  controller.on_move = [] {
    cs8::MoveResult met;
    met.outcome = cs8::Outcome::kUnexpectedContact;
    return met;
  };
  status.enter(State::kStarting);
  EXPECT_FALSE(run(location_.pass()));
  EXPECT_THAT(faults, Contains("unexpected_contact"));
  EXPECT_FALSE(location_.is_locating() || location_.is_passing() || location_.place());
}

TEST_F(BlockLocationTest, APassEndsOnceThePlaceIsOnTheDiskAndHoldsUpNothingUntilThen) {
  boost::asio::io_context disk{1};
  StoreQueue slow{store, disk.get_executor()};
  BlockLocation location(io.get_executor(), io.get_executor(), cell_of_owners(), slow, session, status, wake,
                         time.clocks());
  const auto file = folder.path() / "place.json";
  location.keep_in(file);
  touch_all_spots(location);
  ASSERT_FALSE(location.locate());
  status.enter(State::kStarting);
  std::optional<bool> found;
  boost::asio::co_spawn(io, location.pass(),
                        [&found](const std::exception_ptr&, bool was_found) { found = was_found; });
  io.restart();
  io.poll();
  EXPECT_THAT(controller.asked, Contains("finish")) << "the arm has been around";
  EXPECT_FALSE(found || location.place());
  EXPECT_TRUE(location.is_passing());
  status.enter(State::kStopping);  // a stop is not held up; the place is proven, and counts
  disk.run();
  EXPECT_TRUE(std::filesystem::exists(file));
  io.poll();
  EXPECT_EQ(found, true);
  EXPECT_TRUE(location.place());
  EXPECT_FALSE(location.is_passing() || location.is_locating());
}

TEST_F(BlockLocationTest, AStopDoesNotWaitForTheComputationOfAPassAndNothingMovesBehindIt) {
  boost::asio::io_context arithmetic{1};
  BlockLocation location(io.get_executor(), arithmetic.get_executor(), cell_of_owners(), queue, session,
                         status, wake, time.clocks());
  const auto compute = [&] {
    arithmetic.restart();
    EXPECT_EQ(arithmetic.run(), 1u);
    settle();
  };
  ASSERT_FALSE(location.locate());
  for (const PlaceSpot& spot : place_spots(cell_of_owners())) {
    touch(location, at(spot));
    compute();
  }
  ASSERT_FALSE(location.locate());
  status.enter(State::kStarting);
  std::optional<bool> found;
  boost::asio::co_spawn(io, location.pass(),
                        [&found](const std::exception_ptr&, bool was_found) { found = was_found; });
  settle();
  EXPECT_EQ(found, std::nullopt);
  status.enter(State::kStopping);
  compute();
  EXPECT_EQ(found, false);
  EXPECT_THAT(controller.asked, Not(Contains(StartsWith("travel"))));
  EXPECT_FALSE(location.is_passing());
  EXPECT_TRUE(location.is_locating()) << "it can be tried again";
}

TEST_F(BlockLocationTest, APlaceIsComputedBesideTheLinkAndAStopMeanwhileForgetsIt) {
  boost::asio::io_context arithmetic{1};
  BlockLocation location(io.get_executor(), arithmetic.get_executor(), cell_of_owners(), queue, session,
                         status, wake, time.clocks());
  ASSERT_FALSE(location.locate());
  const std::vector<PlaceSpot> spots = place_spots(cell_of_owners());
  for (const PlaceSpot& spot : spots) {
    touch(location, at(spot));
    EXPECT_EQ(location.guide().value().index, static_cast<int>(&spot - spots.data()) + 1);
    EXPECT_THAT(location.locate().value().detail, HasSubstr("being stored"));
    if (&spot == &spots.back()) break;
    arithmetic.restart();
    EXPECT_EQ(arithmetic.run(), 1u);
    settle();
  }
  EXPECT_EQ(location.guide().value().step, HandStep::kTouch) << "its place is not computed yet";
  location.leave();
  arithmetic.restart();
  EXPECT_EQ(arithmetic.run(), 1u);
  settle();
  EXPECT_FALSE(location.is_locating());
}

TEST_F(BlockLocationTest, ABlockThatLeavesNoRoomForThePassIsNotGoneAroundWhichIsSaid) {
  const Cell cramped = cramped_cell();
  BlockLocation location(io.get_executor(), io.get_executor(), cramped, queue, session, status, wake,
                         time.clocks());
  touch_all_spots(location);
  const std::string why = location.guide().value().problem.value_or("");
  EXPECT_THAT(why, HasSubstr("leaves no room to pass it at 30 mm"));
  EXPECT_EQ(location.locate().value().detail, why);
  EXPECT_FALSE(location.is_passing());
  EXPECT_TRUE(location.is_locating()) << "the touches stay";
  EXPECT_TRUE(faults.empty());
}

TEST_F(BlockLocationTest, NothingIsWrittenToADirectoryThatTookThePlaceOfItsOwn) {
  const std::filesystem::path own = folder.path(), aside = own.string() + ".aside";
  location_.keep_in(own / "place.json");
  location_.keep_dialogue_in(own / "locating.json", "digest");
  touch_all_spots();
  ASSERT_FALSE(location_.locate());
  status.enter(State::kStarting);
  std::filesystem::rename(own, aside);
  std::filesystem::create_directory(own);
  EXPECT_FALSE(run(location_.pass()));
  EXPECT_THAT(status.fault().value().message(), HasSubstr("moved, removed or replaced"));
  EXPECT_FALSE(location_.place());
  status.enter(State::kIdle);
  location_.undo();
  settle();
  EXPECT_THAT(location_.guide().value().problem.value_or(""), HasSubstr("moved, removed or replaced"));
  EXPECT_TRUE(std::filesystem::is_empty(own));
  std::filesystem::remove(own);
  std::filesystem::rename(aside, own);
}

TEST_F(BlockLocationTest, APlaceThatCannotBeStoredIsNotUsed) {
  location_.keep_in(folder.path() / "no such folder" / "place.json");
  touch_all_spots();
  ASSERT_FALSE(location_.locate());
  status.enter(State::kStarting);
  EXPECT_FALSE(run(location_.pass()));
  EXPECT_THAT(faults, Contains("store_failed"));
  EXPECT_FALSE(location_.place() || location_.is_passing());
  EXPECT_TRUE(location_.is_locating()) << "it can be tried again";
}

TEST_F(BlockLocationTest, APassWaitsUntilWhatIsOpenAtTheControllerIsSettled) {
  touch_all_spots();
  session.set_open_touch({.session = 1, .sequence = 3, .planned = plan_of_owners().touches.touches[0]});
  EXPECT_TRUE(location_.locate());
  EXPECT_FALSE(location_.is_passing());
  session.drop_open_touch();
  status.set_fault({FaultCode::kCollision, {}});
  EXPECT_EQ(location_.locate().value().code, FaultCode::kFaultUnacknowledged);
}

}  // namespace
}  // namespace cell
