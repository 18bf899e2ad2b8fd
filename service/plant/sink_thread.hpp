#pragma once

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <deque>
#include <filesystem>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <stop_token>
#include <string>
#include <thread>

#include "service/plant/sink.hpp"
#include "service/store/sink_state.hpp"

namespace cell {

/// What a SinkThread needs of the daemon.
struct SinkParts {
  std::string name;             // as in SinkState
  std::filesystem::path store;  // the database, read over connections of its own
  std::shared_ptr<SinkStates> states;
  /// Connects; called on the thread of the sink, again after each trouble.
  std::function<std::unique_ptr<Sink>(const std::stop_token&)> connect;
  /// What has confirmed facts and then dies may have lost those of this time: only what was confirmed so long
  /// ago, over a connection that is still there, is `confirmed`; the rest is sent once more over the next
  /// one. None: what is confirmed is kept.
  std::chrono::seconds may_lose{0};
  std::function<std::chrono::steady_clock::time_point()> clock = {};  // of may_lose; not asked without
  /// All up to a number is confirmed: to be kept on the store's thread, which nobody waits for.
  std::function<void(std::int64_t)> confirmed;
  /// Waits between two tries, less when it is to end. A test's own.
  std::function<void(std::stop_token, std::chrono::milliseconds)> wait = {};
};

/// Hands the facts of the outbox to a sink, on a thread of its own, in order, from where the sink has
/// confirmed. What goes wrong is told in its state and the log, and tried again after a pause of kPauseMin to
/// kPauseMax, twice as long each time. Nobody waits for it, but its end: at most for one call of the sink.
class SinkThread {
 public:
  static constexpr std::chrono::milliseconds kPauseMin{1000};
  static constexpr std::chrono::milliseconds kPauseMax{60'000};
  /// How often it looks for new facts.
  static constexpr std::chrono::milliseconds kLook{500};
  static constexpr int kBatch = 100;

  explicit SinkThread(SinkParts parts);
  SinkThread(const SinkThread&) = delete;
  SinkThread& operator=(const SinkThread&) = delete;

 private:
  struct Confirmed {
    std::chrono::steady_clock::time_point at;
    std::int64_t seq = 0;
  };

  void run(std::stop_token ending);
  void serve(const OutboxReader& reader, std::stop_token ending);
  void go_back_to(const OutboxReader& reader, std::int64_t has);
  [[nodiscard]] std::chrono::steady_clock::time_point now() const;
  void keep_what_lasts();
  void tell(const OutboxReader* reader, bool connected, const std::optional<std::string>& trouble);
  void pause(const OutboxReader* reader, const std::string& trouble, std::stop_token ending);

  SinkParts parts_;
  std::int64_t cursor_ = 0;            // confirmed
  std::int64_t kept_ = 0;              // confirmed for good; the store may hear of it later
  std::deque<Confirmed> may_be_lost_;  // what was confirmed over this connection since
  std::chrono::milliseconds pause_{kPauseMin};
  std::optional<std::string> logged_trouble_ = "it is not connected yet";
  bool is_far_behind_ = false;
  std::jthread thread_;  // the last member: it uses all others
};

}  // namespace cell
