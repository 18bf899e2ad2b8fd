#include "service/daemon/daily_care.hpp"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <boost/asio/steady_timer.hpp>
#include <boost/asio/this_coro.hpp>
#include <boost/asio/use_awaitable.hpp>
#include <chrono>
#include <functional>
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

}  // namespace

void care_for(const RunStore& store, const Cell& cell, const DailyCare& care,
              std::chrono::system_clock::time_point now) {
  std::optional<std::string> oldest;
  if (care.retain_days) oldest = format_utc(now - std::chrono::days(*care.retain_days));
  if (oldest) {
    log_failure("old runs could not be deleted", [&] {
      const int deleted = delete_runs_before(store.database(), *oldest,
                                             std::min(kDaysThatAgree, *care.retain_days), care.sinks);
      if (deleted > 0) spdlog::info("{} runs older than {} days were deleted", deleted, *care.retain_days);
    });
  }
  log_failure("old facts could not be deleted", [&] { delete_facts(store.database(), care.sinks, oldest); });
  log_failure("certificates that end could not be told of", [&] {
    for (const ExpiringCertificate& certificate : expiring_certificates(cell, now))
      Outbox(store.database()).tell_expiring(certificate, format_utc(now));
  });
}

asio::awaitable<void> care_daily(const RunStore& store, const Cell& cell, DailyCare care,
                                 asio::any_io_executor disk, Clocks clocks) {
  asio::steady_timer day(co_await asio::this_coro::executor);
  for (;;) {
    const auto care_now = [&store, &cell, care, now = clocks.system()] { care_for(store, cell, care, now); };
    co_await run_on(disk, care_now);
    day.expires_after(std::chrono::days(1));
    co_await day.async_wait(asio::use_awaitable);
  }
}

}  // namespace cell
