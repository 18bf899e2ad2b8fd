#pragma once

#include <boost/asio/any_io_executor.hpp>
#include <boost/asio/awaitable.hpp>
#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "service/http/routes/services.hpp"
#include "service/http/server/http_message.hpp"
#include "service/http/server/request_handler.hpp"
#include "service/store/run_store.hpp"

namespace cell {

inline constexpr int kEventStreamsMax = 32;
inline constexpr std::string_view kRunEventsPath = "/api/v1/runs/{id}/events";

/// Longest silence of a stream: a comment then shows both ends that the connection lives.
inline constexpr std::chrono::seconds kKeepAlivePeriod{15};

/// Reads a run where that holds nobody up; nothing if there is none.
using RunLookUp = std::function<boost::asio::awaitable<std::optional<StoredRun>>(std::int64_t)>;

/// Server-sent events for one client: `status` for each change, in order, once each; `reset` with the whole
/// status if the client's last event is of another instance or too old; `run` with the document of the run at
/// the end of a run's stream. Ids are INSTANCE-SEQUENCE. One that was opened with a token ends when that does
/// not count any more. One whose client has gone while its run was looked up counts as open until that is
/// done: so no more are looked up at once than streams may be open.
class EventStream final : public EventSource {
 public:
  /// `run_id`: only changes during this run, whose end `look_up` tells. `services` must outlive it, and what
  /// `look_up` is at. `keep_alive`: the longest wait.
  EventStream(Services& services, std::optional<std::int64_t> run_id, HttpRequest request,
              RunLookUp look_up = {}, std::chrono::milliseconds keep_alive = kKeepAlivePeriod);
  ~EventStream() override;

  [[nodiscard]] static int open_count(const Services& services) { return *services.open_streams; }
  /// The client has seen the end of its run: the answer 204 ends its reconnecting.
  [[nodiscard]] static bool is_over(const std::optional<std::string>& last_event_id);

  std::string due() override;
  [[nodiscard]] bool ended() const override { return ended_; }
  boost::asio::awaitable<void> wait() override;

 private:
  struct LookedUp;
  void begin_look_up(const boost::asio::any_io_executor& executor);
  boost::asio::awaitable<void> wait_for_run();
  [[nodiscard]] bool is_withdrawn() const;
  [[nodiscard]] std::string id_of(std::uint64_t sequence) const;
  [[nodiscard]] std::string whole_status(const char* event);
  [[nodiscard]] bool may_be_over();

  Services& services_;
  std::optional<std::int64_t> run_id_;
  HttpRequest request_;
  RunLookUp look_up_;
  bool needs_token_;  // over loopback only what was opened with one
  std::chrono::milliseconds keep_alive_;
  std::shared_ptr<void> open_;           // counts among the open streams until its last copy has gone
  std::shared_ptr<LookedUp> looked_up_;  // what is under way; null when nothing is
  std::string first_;                    // the first event, if any
  std::uint64_t seen_ = 0;
  std::optional<std::string> run_at_end_;  // its document, until that is told
  bool ended_ = false;
};

}  // namespace cell
