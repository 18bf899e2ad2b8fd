// What an Api looks at again and again.
#include <spdlog/spdlog.h>

#include <boost/asio/steady_timer.hpp>
#include <boost/asio/use_awaitable.hpp>
#include <optional>
#include <string>
#include <utility>

#include "service/base/run_on.hpp"
#include "service/http/routes/api.hpp"
#include "service/http/routes/internal/desk.hpp"
#include "service/http/routes/internal/stored_checks.hpp"
#include "service/http/routes/internal/token_log.hpp"

namespace cell {

namespace asio = boost::asio;

asio::awaitable<void> Api::follow_tokens(KnownDirectory state_directory, std::chrono::milliseconds every) {
  asio::steady_timer timer(executor_);
  TokenTroubles troubles;
  for (;;) {
    timer.expires_after(every);
    co_await timer.async_wait(asio::use_awaitable);
    const auto look = [state_directory, known = services_.tokens] {
      return tokens_now(state_directory, known);
    };
    CurrentTokens now = co_await run_on(reader_->executor, look);
    troubles.tell(now);
    take_tokens(std::move(now.tokens));
  }
}

void Api::take_users(const UserBook& book) {
  services_.user_book = book;
  take_tokens(services_.tokens);
}

void Api::take_tokens(Tokens now) {
  const Clocks& clocks = services_.operation.clocks();
  now.sessions = session_ends_.sessions_at(services_.user_book, clocks.system(), clocks.steady());
  if (now == services_.tokens) return;
  tell_changes(services_.tokens, now);
  services_.tokens = std::move(now);
  services_.feed.wake();  // streams look whether their token still counts
}

asio::awaitable<void> Api::follow_cell(std::chrono::milliseconds every) {
  asio::steady_timer timer(executor_);
  std::optional<std::string> told;
  for (;;) {
    FoundFigures found = co_await run_on(reader_->executor, [this] {
      Reads& reads = reader_->reads;
      reads.update();
      return cell_figures(reads.store(), reads.cell(), reads.now());
    });
    services_.metrics.take(found.figures);
    if (found.trouble && found.trouble != told)
      spdlog::error("metrics of checks and models are left out: {}", *found.trouble);
    told = std::move(found.trouble);
    timer.expires_after(every);
    co_await timer.async_wait(asio::use_awaitable);
  }
}

asio::awaitable<void> Api::follow_strangers(std::chrono::milliseconds every) {
  asio::steady_timer timer(executor_);
  for (;;) {
    timer.expires_after(every);
    co_await timer.async_wait(asio::use_awaitable);
    audit_.record_left_out();
  }
}

asio::awaitable<void> Api::follow_users(std::chrono::milliseconds every) {
  asio::steady_timer timer(executor_);
  for (;;) {
    timer.expires_after(every);
    co_await timer.async_wait(asio::use_awaitable);
    co_await run_on(threads_.store, [this] { services_.users.keep(); });
  }
}

}  // namespace cell
