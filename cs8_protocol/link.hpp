#pragma once

#include <boost/asio/any_io_executor.hpp>
#include <boost/asio/awaitable.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/steady_timer.hpp>
#include <chrono>
#include <cstdint>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <variant>
#include <vector>

#include "cs8_protocol/client.hpp"
#include "cs8_protocol/codec.hpp"

/// Inside of client.hpp; for client.cpp and link.cpp only.
namespace cs8 {

namespace asio = boost::asio;
using asio::ip::tcp;
using Clock = std::chrono::steady_clock;

/// One connection from its first byte to its last. Coroutines and handlers that run on it keep it alive; once
/// `error_` is set they all end and nothing is read, written or called back but on_loss.
class Link : public std::enable_shared_from_this<Link> {
 public:
  Link(const asio::any_io_executor& executor, const ClientOptions& options, ClientHooks hooks)
      : executor_(executor),
        options_(options),
        hooks_(std::move(hooks)),
        socket_(executor),
        connect_alarm_(executor),
        heartbeat_timer_(executor),
        silence_timer_(executor) {}

  static asio::awaitable<ConnectReply> open(std::shared_ptr<Link> link, tcp::endpoint endpoint,
                                            ExpectedController expected);
  template <class Result, class Command>
  static asio::awaitable<Reply<Result>> command(std::shared_ptr<Link> link, const Command& body);
  static asio::awaitable<QueryReply> query(std::shared_ptr<Link> link, std::uint32_t sequence,
                                           std::chrono::milliseconds deadline);
  static asio::awaitable<PermitReply> begin(std::shared_ptr<Link> link, std::uint32_t run,
                                            std::chrono::milliseconds confirm_within);

  void send(const Message& message);
  void stop();
  void fail(LinkErrorKind kind, std::string text);
  void close();

  [[nodiscard]] bool is_up() const { return established_ && !error_; }
  /// Whether the owner takes it to be up: also while its loss is still to be told.
  [[nodiscard]] bool is_held_up() const { return is_up() || loss_is_due_; }
  [[nodiscard]] std::uint32_t last_sequence() const { return last_sequence_; }
  [[nodiscard]] const std::optional<State>& latest_state() const { return latest_state_; }
  [[nodiscard]] const std::optional<Permit>& latest_permit() const { return latest_permit_; }
  [[nodiscard]] std::optional<Clock::time_point> heard_at() const { return heard_at_; }

 private:
  using Answer = std::variant<TouchResult, MoveResult, ResultUnknown, Rejected>;

  /// A call that waits for the controller.
  struct Pending {
    asio::steady_timer alarm;  // its deadline; cancelled to wake the call
    std::string what;          // is asked for, in words
    bool accepted = false;
    bool done = false;
    std::optional<Clock::time_point> settle_by;  // sooner than its own deadline
  };

  /// The one call that waits for an answer; lives in its coroutine.
  struct Waiting : Pending {
    Waiting(Link& on_link, std::uint32_t of_sequence, MessageType wants);
    ~Waiting();
    Waiting(const Waiting&) = delete;
    Waiting& operator=(const Waiting&) = delete;
    [[nodiscard]] bool takes(const Answer& offered) const;

    Link& link;
    const std::uint32_t sequence;
    const MessageType wanted;  // kTouchResult, kMoveResult, or kResultUnknown for a query
    std::optional<Answer> answer;
    std::optional<Clock::time_point> idle_since;  // by State it is not running
    bool is_asked_for = false;                    // the result that did not come
    bool is_stopped = false;
  };

  /// The one begin() that waits for its permit; lives in its coroutine.
  struct Asking : Pending {
    Asking(Link& on_link, std::uint32_t for_run);
    ~Asking();
    Asking(const Asking&) = delete;
    Asking& operator=(const Asking&) = delete;

    Link& link;
    const std::uint32_t run;
    Permit decision;
  };

  /// The rest of command(), once its bytes are gone; `sequence` is 0 when they are not.
  template <class Result>
  static asio::awaitable<Reply<Result>> answer_to(std::shared_ptr<Link> link, std::uint32_t sequence,
                                                  std::chrono::milliseconds deadline);

  /// Returns when `pending` is done or the link is down.
  asio::awaitable<void> wait(Pending& pending, Clock::time_point accept_by, Clock::time_point answer_by);

  static LinkError not_connected(const Link* link);
  void greet(const DecodeResult& frame, const ExpectedController& expected);
  void establish(const Welcome& welcome);
  void spawn(asio::awaitable<void> loop);
  asio::awaitable<void> read_loop();
  void send_heartbeat();
  asio::awaitable<void> heartbeat_loop();
  asio::awaitable<void> silence_loop();
  void flush();

  void take(const Message& message);
  void take_state(const State& state);
  void watch_command(const State& state);
  void take_acceptance();
  bool take_permit(const Permit& permit);                          // false: it was not asked for
  bool take_answer(std::uint32_t sequence, const Answer& answer);  // false: it answers nothing

  asio::any_io_executor executor_;
  ClientOptions options_;
  ClientHooks hooks_;
  tcp::socket socket_;
  asio::steady_timer connect_alarm_;
  asio::steady_timer heartbeat_timer_;
  asio::steady_timer silence_timer_;
  std::vector<std::uint8_t> outgoing_;   // whole frames that wait
  std::vector<std::uint8_t> in_flight_;  // whole frames being written
  bool established_ = false;
  std::optional<LinkError> error_;
  bool loss_is_due_ = false;  // on_loss is posted
  Welcome welcome_;
  std::uint32_t last_sequence_ = 0;
  std::uint32_t last_answered_ = 0;
  std::optional<State> latest_state_;
  std::optional<Permit> latest_permit_;
  std::optional<Clock::time_point> heard_at_;
  Clock::time_point greeted_at_;        // zero of the clock in heartbeats
  std::set<std::uint32_t> runs_begun_;  // on this connection
  Waiting* waiting_ = nullptr;
  Asking* asking_ = nullptr;
};

}  // namespace cs8
