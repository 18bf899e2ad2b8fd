// The touches of a dialogue that outlive their daemon.
#include <gmock/gmock.h>

#include <algorithm>
#include <boost/asio/co_spawn.hpp>
#include <filesystem>
#include <optional>

#include "tests/service/acquisition/block_location_bench.hpp"

namespace cell {
namespace {

using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::StartsWith;

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
