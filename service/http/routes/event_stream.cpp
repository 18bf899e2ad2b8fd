#include "service/http/routes/internal/event_stream.hpp"

#include <spdlog/fmt/fmt.h>

#include <boost/asio/any_io_executor.hpp>
#include <boost/asio/co_spawn.hpp>
#include <boost/asio/experimental/awaitable_operators.hpp>
#include <boost/asio/redirect_error.hpp>
#include <boost/asio/steady_timer.hpp>
#include <boost/asio/this_coro.hpp>
#include <boost/asio/use_awaitable.hpp>
#include <charconv>
#include <exception>
#include <utility>

#include "service/acquisition/cell_operation.hpp"
#include "service/documents/json_view.hpp"
#include "service/http/auth/access.hpp"

namespace cell {

namespace asio = boost::asio;

namespace {

constexpr std::string_view kEnd = "-end";
/// Largest amount written at once.
constexpr std::size_t kDueBytesMax = 64 * 1024;

std::string event_text(std::string_view event, std::string_view id, std::string_view data) {
  return fmt::format("event: {}\nid: {}\ndata: {}\n\n", event, id, data);
}

/// The sequence number in an id of this instance.
std::optional<std::uint64_t> sequence_of(std::string_view id, const std::string& instance_id) {
  if (!id.starts_with(instance_id + "-")) return std::nullopt;
  id.remove_prefix(instance_id.size() + 1);
  std::uint64_t sequence = 0;
  const auto [end, error] = std::from_chars(id.data(), id.data() + id.size(), sequence);
  if (error != std::errc{} || end != id.data() + id.size()) return std::nullopt;
  return sequence;
}

/// One more that is open, until its last copy has gone.
std::shared_ptr<void> counted(std::shared_ptr<int> open) {
  ++*open;
  return {nullptr, [open = std::move(open)](std::nullptr_t) { --*open; }};
}

}  // namespace

/// A look-up, and what it has found once it is done.
struct EventStream::LookedUp {
  explicit LookedUp(const asio::any_io_executor& executor)
      : until(executor, asio::steady_timer::time_point::max()) {}

  void take(std::exception_ptr thrown, std::optional<StoredRun> found) {
    is_done = true;
    failure = std::move(thrown);
    run = std::move(found);
    until.cancel();
  }
  static asio::awaitable<void> until_done(std::shared_ptr<LookedUp> looked_up) {
    boost::system::error_code ignored;
    if (!looked_up->is_done)
      co_await looked_up->until.async_wait(asio::redirect_error(asio::use_awaitable, ignored));
  }

  bool is_done = false;
  std::exception_ptr failure;
  std::optional<StoredRun> run;
  asio::steady_timer until;  // rings by take()
};

EventStream::EventStream(Services& services, std::optional<std::int64_t> run_id, HttpRequest request,
                         RunLookUp look_up, std::chrono::milliseconds keep_alive)
    : services_(services),
      run_id_(run_id),
      request_(std::move(request)),
      look_up_(std::move(look_up)),
      needs_token_(!request_.from_loopback || shows_token(request_, services.tokens)),
      keep_alive_(keep_alive),
      open_(counted(services.open_streams)) {
  const auto& last_event_id = request_.last_event_id;
  first_ = "retry: 2000\n\n";
  const auto known = last_event_id ? sequence_of(*last_event_id, services_.feed.instance_id()) : std::nullopt;
  services_.feed.newest();
  if (known && services_.feed.remembers(*known)) {
    seen_ = *known;
  } else {
    first_ += whole_status(last_event_id ? "reset" : "status");
  }
}

EventStream::~EventStream() = default;

bool EventStream::is_over(const std::optional<std::string>& last_event_id) {
  return last_event_id && last_event_id->ends_with(kEnd);
}

std::string EventStream::id_of(std::uint64_t sequence) const {
  return fmt::format("{}-{}", services_.feed.instance_id(), sequence);
}

std::string EventStream::whole_status(const char* event) {
  seen_ = services_.feed.newest().sequence;
  return event_text(event, id_of(seen_), services_.feed.document());
}

bool EventStream::is_withdrawn() const { return needs_token_ && !shows_token(request_, services_.tokens); }

std::string EventStream::due() {
  if (is_withdrawn()) {
    ended_ = true;
    return {};
  }
  std::string text = std::exchange(first_, {});
  services_.feed.newest();
  const StatusFeed& feed = services_.feed;
  if (!feed.remembers(seen_)) return text + whole_status("reset");
  while (text.size() < kDueBytesMax) {
    const StatusFeed::Change* change = feed.next(seen_);
    if (!change) break;
    seen_ = change->sequence;
    if (!run_id_ || change->run_id == run_id_)
      text += event_text("status", id_of(seen_), feed.document(*change));
  }
  if (feed.next(seen_) || !run_at_end_) return text;
  ended_ = true;
  return text + event_text("run", id_of(seen_) + std::string(kEnd), *run_at_end_);
}

/// It is not under way by what is published, and how it ended stands in the store.
bool EventStream::may_be_over() {
  if (!run_id_) return false;
  const StatusFeed::Change& newest = services_.feed.newest();
  return newest.run_id != run_id_ || !newest.is_active;
}

/// Beside the stream, which is told in between that it lives: a disk may take long.
void EventStream::begin_look_up(const asio::any_io_executor& executor) {
  looked_up_ = std::make_shared<LookedUp>(executor);
  asio::co_spawn(executor, look_up_(*run_id_),
                 [open = open_, found = std::weak_ptr(looked_up_)](std::exception_ptr failure,
                                                                   std::optional<StoredRun> run) {
                   if (const auto looked_up = found.lock())  // else the client has gone
                     looked_up->take(std::move(failure), std::move(run));
                 });
}

/// Returns when the run is known, when there is something to tell, or after the longest wait.
asio::awaitable<void> EventStream::wait_for_run() {
  using asio::experimental::awaitable_operators::operator||;  // whichever is first
  auto told = services_.feed.wait(seen_, keep_alive_);
  auto first = std::move(told) || LookedUp::until_done(looked_up_);
  co_await std::move(first);
  if (!looked_up_->is_done) co_return;
  const auto found = std::exchange(looked_up_, nullptr);
  if (found->failure) std::rethrow_exception(found->failure);
  if (found->run && found->run->ended_at) run_at_end_ = run_document(*found->run);
}

asio::awaitable<void> EventStream::wait() {
  if (is_withdrawn()) co_return;  // while something was written or read: nobody wakes it for that again
  const auto& now = services_.operation.clocks().steady;
  const auto at_latest = now() + keep_alive_;
  if (!looked_up_ && may_be_over()) begin_look_up(co_await asio::this_coro::executor);
  if (looked_up_) co_await wait_for_run();
  if (looked_up_ || run_at_end_ || is_withdrawn()) co_return;
  const auto left = std::chrono::ceil<std::chrono::milliseconds>(at_latest - now());
  co_await services_.feed.wait(seen_, left);
}

}  // namespace cell
