#pragma once

#include <SQLiteCpp/SQLiteCpp.h>
#include <gtest/gtest.h>
#include <sqlite3.h>

#include <algorithm>
#include <string>
#include <vector>

#include "service/acquisition/touch_executor.hpp"
#include "tests/service/acquisition/owners_bench.hpp"

namespace cell {

/// A TouchExecutor in a run that has its plan, on a controller that answers with the contact of an arm
/// without errors.
class ExecutorBench : public ::testing::Test, public OwnersBench {
 protected:
  ExecutorBench() {
    controller.on_touch = [this](const cs8::Touch&) { return contact(); };
    confirm(static_cast<std::uint32_t>(active_.run.id()));
    touches_.begin_run(active_);
    status.enter(State::kExecute);
  }
  /// Nothing that was stored is missing from the run, nor the other way about.
  void expect_run_is_as_stored() {
    const std::vector<StoredTouch> stored = store.touches(active_.run.id());
    EXPECT_EQ(static_cast<int>(stored.size()), active_.run.touches_done());
  }
  /// From here on every commit fails.
  void break_store() {
    sqlite3_commit_hook(
        store.database()->getHandle(), [](void*) { return 1; }, nullptr);
  }
  void mend_store() { sqlite3_commit_hook(store.database()->getHandle(), nullptr, nullptr); }
  [[nodiscard]] long acknowledged_count() const {
    return std::ranges::count_if(controller.asked,
                                 [](const std::string& one) { return one.starts_with("acknowledge"); });
  }

  ActiveRun active_ = planned_run();
  TouchExecutor touches_{cell_of_owners(), computation, queue, session,      preparation,
                         block_move,       status,      wake,  time.clocks()};
};

}  // namespace cell
