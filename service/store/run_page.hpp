#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "service/store/run_store.hpp"

namespace cell {

/// A run whose row is not what was written. Nothing but its number is told of it.
struct DamagedRun {
  std::int64_t id = 0;
  std::string what;  // with file, table and remedy, as DamagedStore says it
};

/// Runs, newest first. `next_before` is the id that the next page begins before; nothing on the last.
struct RunPage {
  std::vector<StoredRun> runs;
  std::vector<DamagedRun> damaged;
  std::optional<std::int64_t> next_before;
};

/// At most `limit` runs, before `before_id` where one is given. One damaged row does not hide the others.
/// Throws DamagedStore where the file itself is damaged.
RunPage run_page(const RunStore& store, int limit, std::optional<std::int64_t> before_id);

}  // namespace cell
