#include "service/daemon/daily_care.hpp"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <boost/asio/steady_timer.hpp>
#include <boost/asio/this_coro.hpp>
#include <boost/asio/use_awaitable.hpp>
#include <chrono>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <utility>

#include "service/base/run_on.hpp"
#include "service/base/utc_time.hpp"
#include "service/run/expiring_certificates.hpp"
#include "service/store/maintenance.hpp"
#include "service/store/outbox.hpp"

namespace cell {

namespace asio = boost::asio;

namespace {

void log_failure(const char* what, const std::function<void()>& work) {
  try {
    work();
  } catch (const std::exception& error) {
    spdlog::error("{}: {}", what, error.what());
  }
}

std::string oldest_kept(int retain_days, std::chrono::system_clock::time_point now) {
  return format_utc(now - std::chrono::days(retain_days));
}

/// Who keeps a day has no more days than that.
int days_that_agree(int retain_days) { return std::min(kDaysThatAgree, retain_days); }

}  // namespace

bool care_for(const RunStore& store, const Cell& cell, const DailyCare& care,
              std::chrono::system_clock::time_point now) {
  if (care.retain_days) {
    log_failure("old runs could not be deleted", [&] {
      const int deleted = delete_runs_before(store.database(), oldest_kept(*care.retain_days, now),
                                             days_that_agree(*care.retain_days), care.sinks);
      if (deleted > 0) spdlog::info("{} runs older than {} days were deleted", deleted, *care.retain_days);
    });
  }
  log_failure("certificates that end could not be told of", [&] {
    Outbox(store.database()).tell_expiring(expiring_certificates(cell, now), format_utc(now));
  });
  return delete_old_facts(store, care, now);
}

bool delete_old_facts(const RunStore& store, const DailyCare& care,
                      std::chrono::system_clock::time_point now) {
  std::optional<FactsKept> since;
  if (care.retain_days)
    since = FactsKept{.oldest = oldest_kept(*care.retain_days, now),
                      .now = format_utc(now),
                      .days_that_agree = days_that_agree(*care.retain_days)};
  std::int64_t deleted = 0;
  log_failure("old facts could not be deleted",
              [&] { deleted = delete_facts(store.database(), care.sinks, since); });
  return deleted >= kFactsDeletedAtOnce;
}

asio::awaitable<void> care_daily(const RunStore& store, const Cell& cell, DailyCare care,
                                 asio::any_io_executor disk, Clocks clocks) {
  asio::steady_timer day(co_await asio::this_coro::executor);
  for (;;) {
    const auto now = clocks.system();
    const auto care_now = [&store, &cell, care, now] { return care_for(store, cell, care, now); };
    bool more = co_await run_on(disk, care_now);
    // In between the store's thread writes what waits, the touches of a run.
    const auto delete_more = [&store, care, now] { return delete_old_facts(store, care, now); };
    while (more) more = co_await run_on(disk, delete_more);
    day.expires_after(std::chrono::days(1));
    co_await day.async_wait(asio::use_awaitable);
  }
}

}  // namespace cell
