#include "service/http/auth/record_rate.hpp"

#include <gtest/gtest.h>

namespace cell {
namespace {

using namespace std::chrono_literals;

TEST(RecordRate, SomeAtOnceThenOneAPeriodThatSaysHowManyWereLeftOut) {
  RecordRate rate(3, 1000ms);
  const RecordRate::TimePoint start{1h};
  for (int i = 0; i < 3; ++i) EXPECT_EQ(rate.admit(start), 0) << i;
  for (int i = 0; i < 100; ++i) EXPECT_EQ(rate.admit(start + 500ms), std::nullopt);
  EXPECT_EQ(rate.admit(start + 1s), 100);
  EXPECT_EQ(rate.admit(start + 1s), std::nullopt);
  EXPECT_EQ(rate.admit(start + 1h), 1);
  EXPECT_EQ(rate.admit(start + 1h), 0) << "after a rest several at once again";
}

TEST(RecordRate, WhatWasLeftOutIsTakenOnce) {
  RecordRate rate(1, 1000ms);
  const RecordRate::TimePoint start{1h};
  EXPECT_EQ(rate.take_left_out(), 0);
  for (int i = 0; i < 8; ++i) rate.admit(start);
  EXPECT_EQ(rate.take_left_out(), 7);
  EXPECT_EQ(rate.take_left_out(), 0);
  EXPECT_EQ(rate.admit(start + 1s), 0) << "they are told";
}

}  // namespace
}  // namespace cell
