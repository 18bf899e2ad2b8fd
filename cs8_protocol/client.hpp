#pragma once

#include <boost/asio/any_io_executor.hpp>
#include <boost/asio/awaitable.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <variant>

#include "cs8_protocol/messages.hpp"

namespace cs8 {

enum class LinkErrorKind {
  kNotConnected,      // no connection was made, or it was lost before the call
  kUnreachable,       // no TCP connection
  kHandshakeTimeout,  // no connection or no Welcome within the deadline
  kIncompatible,      // another protocol version, application, arm or other joint ranges
  kPeerClosed,        // the controller, its application's end or the network ended the connection
  kSilent,            // no bytes for the heartbeat timeout, or the controller does not read
  kProtocol,    // bytes that are no frame, a message of the wrong side, an answer to nothing that was asked
  kFault,       // the controller said why it closes the connection
  kOccupied,    // the controller serves another host
  kUnanswered,  // the controller lives but did not answer a command, query or Begin within its deadline
  kClosed,      // close() on this side
};

/// Why there is no link (any more). `text` is one line for people.
struct LinkError {
  LinkErrorKind kind{};
  std::string text;
};

/// Who must be at the other end.
struct ExpectedController {
  std::string application = "touchcal";
  std::string arm;
  JointsMicrodeg lower_limits{};
  JointsMicrodeg upper_limits{};
};

/// Joint limits of both sides may differ by this much: files give them rounded.
inline constexpr std::int32_t kJointLimitToleranceMicrodeg = 1000;

struct ClientOptions {
  std::chrono::milliseconds connect_deadline{2000};  // TCP connection and handshake together
  std::chrono::milliseconds heartbeat_period{100};
  std::chrono::milliseconds heartbeat_timeout{500};  // of both sides
  std::chrono::milliseconds answer_deadline{2000};   // until a command or Begin is taken or refused
  std::chrono::milliseconds result_margin{2000};     // added to a command's or confirmation's own deadline
  /// A command that State does not tell as running for so long has lost its result: it is asked for.
  std::chrono::milliseconds result_lost_after{500};
};

/// Called from the io_context, never from inside a call of the client. They may close or destroy the client.
struct ClientHooks {
  std::function<void(const State&)> on_state;
  std::function<void(const Permit&)> on_permit;  // each one, also one that is no longer waited for
  std::function<void()> on_heartbeat;            // with each heartbeat that is sent
  std::function<void(const LinkError&)>
      on_loss;  // once per connection, before a waiting call ends; not after close()
};

/// What became of a motion command; `sequence` is 0 when it was never sent. After a LinkError the command may
/// have run all the same: query(sequence) on the next connection answers that.
template <class Result>
struct Reply {
  std::uint32_t sequence = 0;
  std::variant<Result, Rejected, LinkError> answer;
};
using TouchReply = Reply<TouchResult>;
using MoveReply = Reply<MoveResult>;
using QueryReply = std::variant<TouchResult, MoveResult, ResultUnknown, LinkError>;
using PermitReply = std::variant<Permit, LinkError>;
using ConnectReply = std::variant<Welcome, LinkError>;

class Link;

/// The host's side of one connection at a time, all on one thread: that of the executor.
///
/// Every failure of the link ends the call that waits with a LinkError and closes the socket, on which the
/// controller stops; what was asked is then found out by connect() and query(). One motion command or query
/// at a time, and one begin() beside it: a second one is std::logic_error. Every wait has a deadline, so do
/// not block the thread for long. A result is not acknowledged here: the owner does it when it is stored.
class Client {
 public:
  explicit Client(boost::asio::any_io_executor executor, ClientOptions options = {}, ClientHooks hooks = {});
  ~Client();  // as close()
  Client(const Client&) = delete;
  Client& operator=(const Client&) = delete;

  /// Connects and shakes hands; ends a connection that is open. Sequence numbers go on from
  /// Welcome::last_sequence. They mean something only within Welcome::session, which the owner compares with
  /// the one it remembers.
  boost::asio::awaitable<ConnectReply> connect(boost::asio::ip::tcp::endpoint endpoint,
                                               ExpectedController expected);
  /// Ends the connection; a call that waits ends with kClosed. Nothing is called back afterwards.
  void close();
  /// Until on_loss has told the end: an owner that connects anew as soon as this is false knows why it has
  /// to.
  [[nodiscard]] bool connected() const;

  /// Asks for a run. The reply's state is kGranted once a person confirmed at the cell, else kNone with the
  /// reason; kAwaited in between is passed to on_permit. A permit is lost with the connection and may be
  /// withdrawn at any time: see on_permit and latest_permit().
  boost::asio::awaitable<PermitReply> begin(std::uint32_t run, std::chrono::milliseconds confirm_within);
  /// Gives the permit back; ends a begin() that waits. Nothing when not connected.
  void finish();
  /// The newest Permit of this connection.
  [[nodiscard]] std::optional<Permit> latest_permit() const;

  /// The newest State of this connection, and when the last bytes came from the controller.
  [[nodiscard]] std::optional<State> latest_state() const;
  [[nodiscard]] std::optional<std::chrono::steady_clock::time_point> heard_at() const;

  /// The number the next motion command will have, to be stored before it is sent; 0 when not connected.
  [[nodiscard]] std::uint32_t next_sequence() const;

  /// Motion commands are sent when these are called, before they return; await the reply at once. A result
  /// that is lost on its way is asked for once State tells that the command no longer runs.
  boost::asio::awaitable<TouchReply> touch(Touch command);
  boost::asio::awaitable<MoveReply> travel(Travel command);
  boost::asio::awaitable<MoveReply> retract(Retract command);

  /// The result of a command of this session; waits while it still runs, `deadline` at most.
  boost::asio::awaitable<QueryReply> query(std::uint32_t sequence, std::chrono::milliseconds deadline);

  /// Sent at once, also while a command runs; that command's reply then says kStopped. When neither the reply
  /// nor a State that tells it as running comes within the answer deadline, the connection is ended. Nothing
  /// when not connected.
  void stop();
  /// Lets the controller forget a result. Call it when the result is stored for good.
  void acknowledge(std::uint32_t sequence);

 private:
  boost::asio::any_io_executor executor_;
  ClientOptions options_;
  ClientHooks hooks_;
  std::shared_ptr<Link> link_;  // shared with the coroutines that run on it
};

}  // namespace cs8
