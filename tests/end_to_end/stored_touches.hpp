#pragma once

#include <gtest/gtest.h>

#include <set>

#include "tests/end_to_end/loopback_cell.hpp"

namespace touchcal::testing {

/// The store holds the first `count` touches of the run's plan, each of them once.
inline void expect_touches_once(LoopbackCell& loop, std::int64_t run_id, int count) {
  const std::vector<cell::StoredTouch> touches = loop.store().touches(run_id);
  ASSERT_EQ(touches.size(), static_cast<std::size_t>(count));
  std::set<cs8::JointsMicrodeg> captures;
  for (std::size_t i = 0; i < touches.size(); ++i) {
    EXPECT_EQ(touches[i].number, static_cast<int>(i) + 1);
    captures.insert(touches[i].joints);
  }
  EXPECT_EQ(captures.size(), touches.size()) << "a capture was stored twice";
}

}  // namespace touchcal::testing
