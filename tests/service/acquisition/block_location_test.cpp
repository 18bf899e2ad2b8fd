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
#include "tests/service/acquisition/owners_bench.hpp"

namespace cell {
namespace {

using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::StartsWith;

class BlockLocationTest : public ::testing::Test, public OwnersBench {
 protected:
  BlockLocationTest() { status.enter(State::kIdle); }

  /// One touch by hand, at this posture.
  void touch(const calib::JointVector& joints) { touch(location_, joints); }
  void touch(BlockLocation& location, const calib::JointVector& joints) {
    jog_against(location, joints);
    settle();
  }
  /// ... of which nobody has stored anything yet.
  static void jog_against(BlockLocation& location, const calib::JointVector& joints) {
    cs8::State state = ScriptedController::ready_state();
    state.joints = to_wire(joints);
    location.on_controller_state(state);
    state.flags = (state.flags | cs8::kProbeTouched) & ~static_cast<std::uint32_t>(cs8::kProbeLoopClosed);
    location.on_controller_state(state);
  }
  /// What was to be stored is, and who waits for it is told.
  void settle() {
    io.restart();
    io.poll();
  }
  /// The ball at the spot, in the orientation of a planned touch of that face over which the arm can come
  /// from its park posture and leave again.
  static calib::JointVector at(const PlaceSpot& spot) {
    const Cell& cell = cell_of_owners();
    static const calib::TransferSpace space(cell.arm.model, cell.collision_scene(), cell.park_joints,
                                            cell.nominal_position_error_m);
    const Eigen::Vector3d& outward = cell.block.faces[static_cast<std::size_t>(spot.face)].plane.outward;
    for (const calib::PlannedTouch& touch : plan_of_owners().touches.touches) {
      if (touch.face != spot.face) continue;
      Eigen::Isometry3d pose = calib::forward_kinematics(cell.arm.model, touch.joints);
      pose.translation() = spot.point_m + cell.probe.stylus.radius_m * outward;
      const auto joints = calib::solve_near(cell.arm.model, pose, touch.joints);
      if (!joints) continue;
      const auto over = pass_postures(cell, {{spot.face, *joints, kHandNoiseMetres}});
      const auto* postures = std::get_if<std::vector<calib::JointVector>>(&over);
      if (postures && calib::can_reach_park(space, postures->front())) return *joints;
    }
    throw std::runtime_error("nobody can touch there");
  }
  /// The whole dialogue, with the block where the cell's file has it.
  void touch_all_spots() { touch_all_spots(location_); }
  void touch_all_spots(BlockLocation& location) {
    ASSERT_FALSE(location.locate());
    for (const PlaceSpot& spot : place_spots(cell_of_owners())) touch(location, at(spot));
  }

  BlockLocation location_{
      io.get_executor(), io.get_executor(), cell_of_owners(), queue, session, status, wake, time.clocks()};
};

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
    io.restart();
    io.poll();
  };
  touch_all_spots(location);
  for (int computed = 0; computed < 2; ++computed) {  // the postures, then the ways
    ASSERT_FALSE(location.locate());
    status.enter(State::kStarting);
    controller.asked.clear();
    std::optional<bool> found;
    boost::asio::co_spawn(io, location.pass(),
                          [&found](const std::exception_ptr&, bool was_found) { found = was_found; });
    io.restart();
    io.poll();
    for (int i = 0; i < computed; ++i) compute();
    EXPECT_EQ(found, std::nullopt);
    status.enter(State::kStopping);
    compute();
    EXPECT_EQ(found, false);
    EXPECT_THAT(controller.asked, Not(Contains(StartsWith("travel"))));
    EXPECT_FALSE(location.is_passing());
    EXPECT_TRUE(location.is_locating()) << "it can be tried again";
  }
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

/// Daemons, one after the other, that keep a dialogue in a folder. One that is replaced was killed: nothing
/// of it gets to act any more.
class KeptDialogueTest : public BlockLocationTest {
 protected:
  void launch_daemon(const std::string& config_digest = "digest") {
    daemon_.emplace(io.get_executor(), io.get_executor(), cell_of_owners(), queue, session, status, wake,
                    time.clocks());
    daemon_->keep_in(place_file());
    daemon_->keep_dialogue_in(dialogue_file(), config_digest);
  }
  void touch_spots(std::size_t count) {
    ASSERT_FALSE(daemon_->locate());
    const auto spots = place_spots(cell_of_owners());
    for (std::size_t i = 0; i < count; ++i) touch(*daemon_, at(spots[i]));
  }
  /// Around the block: where it is then.
  BlockPose found() {
    EXPECT_FALSE(daemon_->locate());
    status.enter(State::kStarting);
    EXPECT_TRUE(run(daemon_->pass())) << status.fault().value_or(Fault{}).message();
    status.enter(State::kIdle);
    settle();
    return daemon_->place().value();
  }
  [[nodiscard]] HandGuide guide() const { return daemon_->guide().value(); }
  [[nodiscard]] std::filesystem::path place_file() const { return folder.path() / "place.json"; }
  [[nodiscard]] std::filesystem::path dialogue_file() const { return folder.path() / "locating.json"; }

  std::optional<BlockLocation> daemon_;
};

TEST_F(KeptDialogueTest, KilledBehindEachTouchItGoesOnWithAllOfThemAndFindsThePlaceOfAnUndisturbedOne) {
  const auto spots = place_spots(cell_of_owners());
  launch_daemon();
  touch_spots(spots.size());
  const BlockPose undisturbed = found();
  EXPECT_FALSE(std::filesystem::exists(dialogue_file())) << "it is over";
  std::filesystem::remove(place_file());
  launch_daemon();
  EXPECT_FALSE(daemon_->guide());
  touch_spots(0);
  for (std::size_t made = 0; made < spots.size(); ++made) {
    touch(*daemon_, at(spots[made]));
    launch_daemon();
    ASSERT_TRUE(daemon_->is_locating());
    EXPECT_EQ(guide().index, static_cast<int>(std::min(made + 2, spots.size())));
    EXPECT_THAT(guide().words, HasSubstr(made == 0 ? "1 touch is kept" : "touches are kept"));
    EXPECT_THAT(guide().words, HasSubstr("touchcal undo takes it back, touchcal stop all"));
  }
  EXPECT_EQ(guide().step, HandStep::kPass);
  const BlockPose place = found();
  EXPECT_EQ(place.cell_from_block.matrix(), undisturbed.cell_from_block.matrix());
  EXPECT_EQ(place.covariance, undisturbed.covariance);
  ASSERT_EQ(place.touches.size(), spots.size());
  for (std::size_t i = 0; i < spots.size(); ++i) {
    EXPECT_EQ(place.touches[i].face, undisturbed.touches[i].face) << i;
    EXPECT_EQ(place.touches[i].joints, undisturbed.touches[i].joints) << i;
    EXPECT_EQ(place.touches[i].std_m, undisturbed.touches[i].std_m) << i;
  }
}

TEST_F(KeptDialogueTest, ATouchCountsOnceItIsOnTheDiskAndOneAtATimeIsWritten) {
  const auto spots = place_spots(cell_of_owners());
  boost::asio::io_context disk{1};
  StoreQueue slow{store, disk.get_executor()};
  const auto launch_slow = [&] {
    daemon_.emplace(io.get_executor(), io.get_executor(), cell_of_owners(), slow, session, status, wake,
                    time.clocks());
    daemon_->keep_dialogue_in(dialogue_file(), "digest");
  };
  launch_slow();
  ASSERT_FALSE(daemon_->locate());
  jog_against(*daemon_, at(spots[0]));
  settle();
  EXPECT_TRUE(daemon_->is_storing());
  EXPECT_EQ(guide().index, 1) << "it does not count yet";
  EXPECT_FALSE(daemon_->can_undo());
  const auto refused = daemon_->locate();
  ASSERT_TRUE(refused) << "the arm goes by touches that may still be taken back";
  EXPECT_THAT(refused->detail, HasSubstr("being stored"));
  jog_against(*daemon_, at(spots[1]));
  EXPECT_THAT(guide().problem.value_or(""), HasSubstr("still being stored"));
  launch_slow();
  EXPECT_FALSE(daemon_->guide()) << "killed before it was written: nobody was told that it counts";
  disk.run();
  settle();
  EXPECT_FALSE(daemon_->guide()) << "what the one before has written is no touch of this one";
  launch_slow();
  EXPECT_EQ(guide().index, 2) << "killed before it was told that it is written";
  jog_against(*daemon_, at(spots[1]));
  disk.restart();
  disk.run();
  EXPECT_EQ(guide().index, 2);
  settle();
  EXPECT_EQ(guide().index, 3);
  EXPECT_EQ(guide().problem, std::nullopt);
}

TEST_F(KeptDialogueTest, ATouchThatWasTakenBackStaysSoAndAStopDiscardsThemAll) {
  launch_daemon();
  touch_spots(2);
  daemon_->undo();
  settle();
  EXPECT_EQ(guide().index, 2);
  launch_daemon();
  EXPECT_EQ(guide().index, 2);
  daemon_->undo();
  settle();
  EXPECT_EQ(guide().index, 1);
  EXPECT_THAT(guide().words, Not(HasSubstr("kept")));
  launch_daemon();
  EXPECT_FALSE(daemon_->guide()) << "nothing is touched";
  touch_spots(2);
  launch_daemon();
  daemon_->leave();
  settle();
  launch_daemon();
  EXPECT_FALSE(daemon_->guide());
}

TEST_F(KeptDialogueTest, TouchesThatStayWhenTheyAreDiscardedAreAWarning) {
  launch_daemon();
  touch_spots(1);
  std::filesystem::remove(dialogue_file());
  std::filesystem::create_directory(dialogue_file());
  daemon_->leave();
  settle();
  ASSERT_TRUE(status.latest().warning);
  EXPECT_EQ(status.latest().warning->code, FaultCode::kStoreFailed);
  EXPECT_THAT(status.latest().warning->message(), HasSubstr(dialogue_file().string()));
}

TEST_F(KeptDialogueTest, TouchesThatBelongToOtherFilesOrAnotherPlaceAreDiscardedWhichIsSaid) {
  const auto expect_discarded = [&](const char* why) {
    EXPECT_EQ(guide().index, 1);
    EXPECT_THAT(guide().words, HasSubstr(why));
    EXPECT_THAT(guide().words, HasSubstr("are discarded, all are made again"));
    settle();
    EXPECT_FALSE(std::filesystem::exists(dialogue_file()));
    daemon_->leave();
    settle();
  };
  launch_daemon();
  touch_spots(2);
  launch_daemon("of other files");
  expect_discarded("the cell's files have changed since");
  touch_spots(2);
  std::filesystem::resize_file(dialogue_file(), 100);
  launch_daemon();
  expect_discarded("locating.json");
  touch_spots(2);
  const LocatingRecord of_two = read_locating(dialogue_file()).value();
  daemon_->leave();
  touch_spots(6);
  found();
  write_locating(dialogue_file(), of_two);
  launch_daemon();
  expect_discarded("the place of the block has changed since");
}

TEST_F(KeptDialogueTest, ADialogueWhosePlaceIsOnTheDiskAlreadyIsOver) {
  launch_daemon();
  touch_spots(6);
  const LocatingRecord record = read_locating(dialogue_file()).value();
  found();
  write_locating(dialogue_file(), record);  // killed between the two files
  launch_daemon();
  EXPECT_TRUE(daemon_->place());
  EXPECT_FALSE(daemon_->guide());
  settle();
  EXPECT_FALSE(std::filesystem::exists(dialogue_file()));
}

TEST_F(KeptDialogueTest, ATouchThatCannotBeWrittenDoesNotCountWhichIsSaid) {
  daemon_.emplace(io.get_executor(), io.get_executor(), cell_of_owners(), queue, session, status, wake,
                  time.clocks());
  daemon_->keep_dialogue_in(folder.path() / "no such folder" / "locating.json", "digest");
  touch_spots(1);
  EXPECT_EQ(guide().index, 1);
  EXPECT_THAT(guide().problem.value_or(""), HasSubstr("it could not be stored: "));
  EXPECT_THAT(guide().problem.value_or(""), HasSubstr("no such folder"));
}

}  // namespace
}  // namespace cell
