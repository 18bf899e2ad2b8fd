#include "service/acquisition/locating_journal.hpp"

#include <gmock/gmock.h>

#include <boost/asio/co_spawn.hpp>

#include "tests/service/acquisition/owners_bench.hpp"

namespace cell {
namespace {

const LocatingTouch kTouch{{1, 2, 3, 4, 5, 6}, 1e-5, "2026-11-24T08:00:00.000Z"};

const std::function<void()> kNothing = [] {};

/// What daemons do with a dialogue in the end: block_location_test.
class LocatingJournalTest : public ::testing::Test, public OwnersBench {
 protected:
  void settle() {
    io.restart();
    io.poll();
  }

  std::filesystem::path file_ = folder.path() / "locating.json";
  LocatingJournal journal_{queue, io.get_executor(), io.get_executor()};
  int told_ = 0;
  LocatingJournal::Then note_ = [this](const std::optional<std::string>& failure) {
    EXPECT_FALSE(failure) << *failure;
    ++told_;
  };
  std::vector<std::string> why_not_forgotten_;
  std::function<void(const std::string&)> told_of_forgetting_ = [this](const std::string& failure) {
    why_not_forgotten_.push_back(failure);
  };
};

TEST_F(LocatingJournalTest, WithoutAFileNothingIsKept) {
  journal_.write({kTouch}, {}, kNothing, note_);
  settle();
  EXPECT_EQ(told_, 1);
  EXPECT_FALSE(journal_.is_writing() || journal_.left({}).record || journal_.left({}).why_not);
}

TEST_F(LocatingJournalTest, TellsOnceItIsWrittenAndGivesItToTheNextDaemon) {
  journal_.keep_in(file_, "digest");
  journal_.write({kTouch}, "place", kNothing, note_);
  EXPECT_TRUE(journal_.is_writing());
  EXPECT_EQ(told_, 0);
  settle();
  EXPECT_FALSE(journal_.is_writing());
  EXPECT_EQ(told_, 1);
  LocatingJournal next(queue, io.get_executor(), io.get_executor());
  next.keep_in(file_, "digest");
  EXPECT_FALSE(next.left("place").why_not);
  EXPECT_EQ(next.left("place").record.value().touches.front().joints, kTouch.joints);
  EXPECT_EQ(next.left("another place").why_not, "the place of the block has changed since");
  next.keep_in(file_, std::nullopt);
  EXPECT_EQ(next.left("place").why_not, "the cell's files have changed since");
}

TEST_F(LocatingJournalTest, WhatIsMadeOfItIsMadeBehindTheDiskAndMayFail) {
  boost::asio::io_context arithmetic{1};
  LocatingJournal journal(queue, io.get_executor(), arithmetic.get_executor());
  journal.keep_in(file_, "digest");
  std::optional<std::string> failure;
  journal.write(
      {kTouch}, {}, [] { throw std::runtime_error("it cannot be computed"); },
      [&](std::optional<std::string> told) { failure = std::move(told); });
  settle();
  EXPECT_TRUE(std::filesystem::exists(file_));
  EXPECT_TRUE(journal.is_writing());
  arithmetic.run();
  settle();
  EXPECT_FALSE(journal.is_writing());
  EXPECT_EQ(failure, "it cannot be computed");
}

TEST_F(LocatingJournalTest, WhoForgetsIsNotToldAndNothingStays) {
  journal_.keep_in(file_, "digest");
  journal_.write({kTouch}, {}, kNothing, note_);
  journal_.forget(told_of_forgetting_);
  EXPECT_FALSE(journal_.is_writing());
  settle();
  EXPECT_EQ(told_, 0);
  EXPECT_FALSE(std::filesystem::exists(file_));
  journal_.write({kTouch}, {}, kNothing, note_);
  settle();
  journal_.write({}, {}, kNothing, note_);
  settle();
  EXPECT_EQ(told_, 2);
  EXPECT_FALSE(std::filesystem::exists(file_)) << "a dialogue without touches";
  EXPECT_THAT(why_not_forgotten_, ::testing::IsEmpty());
}

TEST_F(LocatingJournalTest, TellsWhyAFileStays) {
  std::filesystem::create_directory(file_);  // which unlink() does not remove
  journal_.keep_in(file_, "digest");
  journal_.forget(told_of_forgetting_);
  settle();
  EXPECT_THAT(why_not_forgotten_, ::testing::ElementsAre(::testing::HasSubstr(file_.string())));
}

TEST_F(LocatingJournalTest, AllWhoWaitAreWokenByTheWriteAndByItsEnd) {
  int woken = 0;
  boost::asio::io_context disk{1};
  StoreQueue slow{store, disk.get_executor()};
  LocatingJournal journal(slow, io.get_executor(), io.get_executor());
  journal.keep_in(file_, "digest");
  const auto wait = [&] {
    boost::asio::co_spawn(io, journal.written(), [&](const std::exception_ptr&) { ++woken; });
  };
  wait();
  settle();
  EXPECT_EQ(woken, 1) << "nothing is being written";
  journal.write({kTouch}, {}, kNothing, note_);
  wait();
  wait();
  settle();
  EXPECT_EQ(woken, 1);
  disk.run();
  settle();  // which lets no time pass
  EXPECT_EQ(woken, 3);
  EXPECT_EQ(told_, 1);
  journal.write({kTouch}, {}, kNothing, note_);
  wait();
  settle();
  journal.forget(told_of_forgetting_);
  settle();
  EXPECT_EQ(woken, 4) << "nobody waits for what is over";
}

}  // namespace
}  // namespace cell
