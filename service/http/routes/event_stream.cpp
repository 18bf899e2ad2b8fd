#include "service/http/routes/internal/event_stream.hpp"

#include <spdlog/fmt/fmt.h>

#include <charconv>
#include <utility>

#include "service/documents/json_view.hpp"
#include "service/http/auth/access.hpp"

namespace cell {

using namespace std::chrono_literals;

namespace {

constexpr std::string_view kEnd = "-end";
/// Longest silence: a comment then shows both ends that the connection lives.
constexpr std::chrono::seconds kKeepAlivePeriod{15};
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

}  // namespace

EventStream::EventStream(Services& services, std::optional<std::int64_t> run_id, HttpRequest request,
                         RunLookUp look_up)
    : services_(services),
      run_id_(run_id),
      request_(std::move(request)),
      look_up_(std::move(look_up)),
      needs_token_(!request_.from_loopback || shows_token(request_, services.tokens)),
      open_(services.open_streams) {
  const auto& last_event_id = request_.last_event_id;
  ++*open_;
  first_ = "retry: 2000\n\n";
  const auto known = last_event_id ? sequence_of(*last_event_id, services_.feed.instance_id()) : std::nullopt;
  services_.feed.newest();
  if (known && services_.feed.remembers(*known)) {
    seen_ = *known;
  } else {
    first_ += whole_status(last_event_id ? "reset" : "status");
  }
}

EventStream::~EventStream() { --*open_; }

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
      text += event_text("status", id_of(seen_), change->document(std::nullopt));
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

boost::asio::awaitable<void> EventStream::wait() {
  if (may_be_over()) {
    const auto run = co_await look_up_(*run_id_);
    if (run && run->ended_at) {
      run_at_end_ = run_document(*run);
      co_return;
    }
  }
  if (is_withdrawn()) co_return;  // while something was written or read: nobody wakes it for that again
  co_await services_.feed.wait(seen_, kKeepAlivePeriod);
}

}  // namespace cell
