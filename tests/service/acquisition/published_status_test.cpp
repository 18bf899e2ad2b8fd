#include "service/acquisition/published_status.hpp"

#include <gmock/gmock.h>

#include <stdexcept>

#include "tests/service/acquisition/made_up_time.hpp"

namespace cell {
namespace {

using ::testing::ElementsAre;

class PublishedStatusTest : public ::testing::Test {
 protected:
  PublishedStatusTest() {
    status_.on_change([this](const Status& status) {
      log_.push_back("published " + std::string(state_name(status.state)) +
                     (status.fault ? " with a fault" : ""));
    });
  }

  std::vector<std::string> log_;
  MadeUpTime time_;
  MadeUpWake wake_{time_};
  PublishedStatus status_{
      time_.clocks(),
      wake_,
      "instance",
      {.describe = [this](Status&) { log_.emplace_back("described"); },
       .on_entered = [this](State state) { log_.push_back("entered " + std::string(state_name(state))); },
       .store_fault =
           [this](const std::string& name, const std::string&) {
             log_.push_back("stored " + name);
             if (store_breaks_) throw std::runtime_error("disk full");
           }}};
  bool store_breaks_ = false;
};

TEST_F(PublishedStatusTest, ANewStateIsKnownToTheOthersBeforeItIsPublished) {
  status_.enter(State::kResetting);
  EXPECT_THAT(log_, ElementsAre("entered RESETTING", "described", "published RESETTING"));
  EXPECT_EQ(wake_.wake_count, 1);
  status_.enter(State::kResetting);
  EXPECT_EQ(log_.size(), 3u) << "the same state again is nothing new";
}

TEST_F(PublishedStatusTest, AFaultIsStoredThenPublishedThenActs) {
  status_.enter(State::kExecute);
  log_.clear();
  status_.raise({FaultCode::kNoContact, {}}, Event::kHoldFault);
  EXPECT_THAT(log_, ElementsAre("stored no_contact", "described", "published EXECUTE with a fault",
                                "entered HOLDING", "described", "published HOLDING with a fault"));
}

TEST_F(PublishedStatusTest, AFaultThatCannotBeStoredActsAllTheSame) {
  status_.enter(State::kExecute);
  store_breaks_ = true;
  status_.raise({FaultCode::kCollision, {}}, Event::kAbortFault);
  EXPECT_EQ(status_.state(), State::kAborting);
  EXPECT_EQ(status_.fault().value().code, FaultCode::kCollision);
}

TEST_F(PublishedStatusTest, EachPublicationHasTheNextNumber) {
  const auto before = status_.latest().sequence;
  status_.set_reference_drift(1e-5);
  EXPECT_EQ(status_.latest().sequence, before) << "told nobody yet";
  status_.publish();
  status_.warn({FaultCode::kProbeBounced, {}});
  EXPECT_EQ(status_.latest().sequence, before + 2);
}

TEST_F(PublishedStatusTest, AWarningThatIsOverUncoversTheOneBefore) {
  status_.end_warning(FaultCode::kComputationSlow);
  EXPECT_TRUE(log_.empty()) << "there was none";
  status_.warn({FaultCode::kProbeBounced, {}});
  status_.warn({FaultCode::kComputationSlow, {}});
  status_.end_warning(FaultCode::kComputationSlow);
  EXPECT_EQ(status_.latest().warning.value().code, FaultCode::kProbeBounced);
  EXPECT_EQ(log_.size(), 6u) << "published three times";
  status_.warn({FaultCode::kComputationSlow, {}});
  status_.warn({FaultCode::kLatchMissing, {}});
  status_.end_warning(FaultCode::kComputationSlow);
  EXPECT_EQ(status_.latest().warning.value().code, FaultCode::kLatchMissing) << "newer";
  status_.warn({FaultCode::kComputationSlow, {}});
  status_.warn({FaultCode::kStoreSlow, {}});
  status_.end_warning(FaultCode::kComputationSlow);
  status_.end_warning(FaultCode::kStoreSlow);
  EXPECT_FALSE(status_.latest().warning) << "one that is over does not come back";
}

TEST_F(PublishedStatusTest, WhatIsAwaitedIsPublishedWhenItIsAnother) {
  status_.wait_for("touch_test");
  status_.wait_for("touch_test");
  EXPECT_THAT(log_, ElementsAre("described", "published STOPPED"));
  status_.wait_for(std::nullopt);
  EXPECT_EQ(log_.size(), 4u);
}

TEST_F(PublishedStatusTest, ARunBeginsWithoutWhatTheOneBeforeLeft) {
  status_.set_fault({FaultCode::kNoContact, {}});
  status_.warn({FaultCode::kProbeBounced, {}});
  status_.set_reference_drift(1e-5);
  status_.set_verdict(Verdict::kAccepted);
  status_.begin_run(7);
  const Status& latest = status_.latest();
  EXPECT_EQ(latest.run_id, 7);
  EXPECT_FALSE(latest.fault || latest.warning || latest.reference_drift_m);
  EXPECT_EQ(latest.verdict, Verdict::kNone);
}

}  // namespace
}  // namespace cell
