#pragma once

#include <gtest/gtest.h>

#include "tests/service/acquisition/operation_bench.hpp"

namespace cell {

class CellOperationTest : public ::testing::Test, protected OperationBench {
 protected:
  using OperationBench::OperationBench;

  /// What waits looks at what has become due meanwhile.
  void look_again_in(std::chrono::seconds later) {
    time_.pass(later);
    for (const int percent : {50, 100}) {  // each change of the readiness wakes
      controller_->state->monitor_speed_percent = percent;
      tell_state();
    }
  }
  std::int64_t start_few() { return std::get<Started>(start({.recipe = "few"})).run.id; }
  /// The contact of an arm without errors at a touch of the plan.
  static cs8::TouchResult contact_of(std::size_t touch) {
    return contact_at(plan_of_owners().touches.touches.at(touch).joints);
  }
};

}  // namespace cell
