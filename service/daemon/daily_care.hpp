#pragma once

#include <boost/asio/any_io_executor.hpp>
#include <boost/asio/awaitable.hpp>
#include <optional>
#include <string>
#include <vector>

#include "config/cell.hpp"
#include "service/base/clocks.hpp"
#include "service/store/run_store.hpp"

namespace cell {

struct DailyCare {
  std::optional<int> retain_days;  // nothing: runs and facts are kept for ever
  std::vector<std::string> sinks;  // those that are configured
};

/// What is done once a day: old runs and facts go, and certificates that end soon are told of. On the store's
/// thread; what fails is logged and done the next day. Returns whether more facts are to go than are deleted
/// at once: delete_old_facts() does it.
bool care_for(const RunStore& store, const Cell& cell, const DailyCare& care,
              std::chrono::system_clock::time_point now);

/// The next kFactsDeletedAtOnce of the facts that may go; returns whether there are more.
bool delete_old_facts(const RunStore& store, const DailyCare& care,
                      std::chrono::system_clock::time_point now);

/// The same at once and then daily, on `disk`. What it is given must outlive the executor it runs on.
boost::asio::awaitable<void> care_daily(const RunStore& store, const Cell& cell, DailyCare care,
                                        boost::asio::any_io_executor disk, Clocks clocks);

}  // namespace cell
