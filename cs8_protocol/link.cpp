#include "cs8_protocol/link.hpp"

#include <boost/asio/co_spawn.hpp>
#include <boost/asio/post.hpp>
#include <cstdlib>
#include <exception>
#include <type_traits>
#include <utility>

#include "cs8_protocol/framing.hpp"
#include "cs8_protocol/names.hpp"

namespace cs8 {
namespace {

/// More than this waiting to be written means that the controller stopped reading.
constexpr std::size_t kOutgoingMax = 16384;  // bytes

/// A VAL3 socket that serves one host has no words for a second one: it is silent, or ends the connection.
constexpr const char* kMayBeOccupied =
    "; most likely another host is connected, of which the controller serves one at a time";

std::string milliseconds_text(std::chrono::milliseconds time) { return std::to_string(time.count()) + " ms"; }

std::string degrees_text(std::int32_t microdeg) { return std::to_string(microdeg / 1e6); }

std::string fault_text(const Fault& fault) {
  return "the controller closes the connection: " + std::string(name(fault.code)) + " (detail " +
         std::to_string(fault.detail) + ")";
}

/// Why this is not the controller that is expected; empty when it is.
std::string mismatch(const Welcome& welcome, const ExpectedController& expected) {
  const std::string application(text_of(welcome.application));
  if (application != expected.application) {
    return "the controller runs the application '" + application + "', not '" + expected.application + "'";
  }
  const std::string arm(text_of(welcome.arm));
  if (arm != expected.arm) return "the controller moves an arm '" + arm + "', not '" + expected.arm + "'";
  const auto differ = [](std::int32_t a, std::int32_t b) {
    return std::abs(std::int64_t{a} - b) > kJointLimitToleranceMicrodeg;
  };
  for (std::size_t j = 0; j < welcome.lower_limits.size(); ++j) {
    if (differ(welcome.lower_limits[j], expected.lower_limits[j]) ||
        differ(welcome.upper_limits[j], expected.upper_limits[j])) {
      return "joint " + std::to_string(j + 1) + " of the controller goes from " +
             degrees_text(welcome.lower_limits[j]) + " to " + degrees_text(welcome.upper_limits[j]) +
             " degrees, not from " + degrees_text(expected.lower_limits[j]) + " to " +
             degrees_text(expected.upper_limits[j]);
    }
  }
  return {};
}

}  // namespace

// ---- connecting ----

asio::awaitable<ConnectReply> Link::open(std::shared_ptr<Link> link, tcp::endpoint endpoint,
                                         ExpectedController expected) {
  const auto deadline = link->options_.connect_deadline;
  bool tcp_connected = false;
  link->connect_alarm_.expires_after(deadline);
  link->connect_alarm_.async_wait([link, deadline](const boost::system::error_code& cancelled) {
    if (cancelled || link->established_) return;
    boost::system::error_code no_peer;
    static_cast<void>(link->socket_.remote_endpoint(no_peer));
    link->fail(LinkErrorKind::kHandshakeTimeout,
               "no handshake within " + milliseconds_text(deadline) + (no_peer ? "" : kMayBeOccupied));
  });
  try {
    co_await link->socket_.async_connect(endpoint, asio::use_awaitable);
    tcp_connected = true;
    link->socket_.set_option(tcp::no_delay(true));
    link->socket_.non_blocking(true);
    link->send(Message{0, Hello{static_cast<std::uint32_t>(link->options_.heartbeat_timeout.count())}});
    const DecodeResult frame = co_await read_frame(link->socket_);
    if (!link->error_) link->greet(frame, expected);
  } catch (const boost::system::system_error& failure) {
    link->fail(tcp_connected ? LinkErrorKind::kPeerClosed : LinkErrorKind::kUnreachable,
               tcp_connected
                   ? "the connection ended during the handshake: " + failure.code().message() + kMayBeOccupied
                   : "no connection: " + failure.code().message());
  }
  link->connect_alarm_.cancel();
  if (link->error_) co_return *link->error_;
  co_return link->welcome_;
}

void Link::greet(const DecodeResult& frame, const ExpectedController& expected) {
  if (const auto* error = std::get_if<DecodeError>(&frame)) {
    const bool version = error->kind == DecodeErrorKind::kVersion;
    fail(version ? LinkErrorKind::kIncompatible : LinkErrorKind::kProtocol,
         "the controller's first answer: " + error->text());
    return;
  }
  const auto& message = std::get<Message>(frame);
  if (const auto* fault = std::get_if<Fault>(&message.payload)) {
    const bool version = fault->code == FaultCode::kVersion;
    const bool occupied = fault->code == FaultCode::kOccupied;
    fail(version    ? LinkErrorKind::kIncompatible
         : occupied ? LinkErrorKind::kOccupied
                    : LinkErrorKind::kFault,
         fault_text(*fault) + (occupied ? ": another host is connected" : ""));
  } else if (const auto* welcome = std::get_if<Welcome>(&message.payload)) {
    const std::string difference = mismatch(*welcome, expected);
    if (difference.empty()) {
      establish(*welcome);
    } else {
      fail(LinkErrorKind::kIncompatible, difference);
    }
  } else {
    fail(LinkErrorKind::kProtocol,
         "the controller's first answer is " + std::string(name(type_of(message))) + ", not welcome");
  }
}

void Link::establish(const Welcome& welcome) {
  welcome_ = welcome;
  last_sequence_ = welcome.last_sequence;
  heard_at_ = greeted_at_ = Clock::now();
  established_ = true;
  spawn(read_loop());
  spawn(heartbeat_loop());
  spawn(silence_loop());
}

/// A connection that breaks shows as system_error in whichever loop meets it first; it is caught here only.
void Link::spawn(asio::awaitable<void> loop) {
  asio::co_spawn(executor_, std::move(loop), [self = shared_from_this()](const std::exception_ptr& failure) {
    if (!failure) return;
    try {
      std::rethrow_exception(failure);
    } catch (const boost::system::system_error& error) {
      self->fail(LinkErrorKind::kPeerClosed, "the connection ended: " + error.code().message());
    }
  });
}

// ---- the loops of a connection ----

asio::awaitable<void> Link::read_loop() {
  while (!error_) {
    const DecodeResult frame = co_await read_frame(socket_);
    if (error_) co_return;
    if (const auto* error = std::get_if<DecodeError>(&frame)) {
      fail(LinkErrorKind::kProtocol, "the controller sent " + error->text());
      co_return;
    }
    heard_at_ = Clock::now();
    take(std::get<Message>(frame));
  }
}

void Link::send_heartbeat() {
  const auto host_clock = std::chrono::duration_cast<std::chrono::milliseconds>(Clock::now() - greeted_at_);
  send(Message{0, Heartbeat{static_cast<std::uint32_t>(host_clock.count())}});
}

asio::awaitable<void> Link::heartbeat_loop() {
  while (!error_) {
    send_heartbeat();
    const auto on_heartbeat = hooks_.on_heartbeat;  // a copy, as for on_loss
    if (on_heartbeat) on_heartbeat();
    if (error_) co_return;
    heartbeat_timer_.expires_after(options_.heartbeat_period);
    co_await heartbeat_timer_.async_wait(asio::use_awaitable);
  }
}

asio::awaitable<void> Link::silence_loop() {
  while (!error_) {
    silence_timer_.expires_at(*heard_at_ + options_.heartbeat_timeout);
    co_await silence_timer_.async_wait(asio::use_awaitable);
    if (error_ || Clock::now() < *heard_at_ + options_.heartbeat_timeout) continue;
    if (socket_.available() > 0) {  // bytes arrived in time and are not read yet
      heard_at_ = Clock::now();
    } else {
      fail(LinkErrorKind::kSilent,
           "nothing was heard from the controller for " + milliseconds_text(options_.heartbeat_timeout));
    }
  }
}

// ---- writing ----

void Link::send(const Message& message) {
  if (error_) return;
  encode(message, outgoing_);
  if (outgoing_.size() > kOutgoingMax) {
    fail(LinkErrorKind::kSilent, "the controller does not read what is sent to it");
  } else {
    flush();
  }
}

void Link::stop() {
  send(Message{0, Stop{}});
  if (error_ || waiting_ == nullptr || waiting_->done) return;
  waiting_->is_stopped = true;
  waiting_->settle_by = Clock::now() + options_.answer_deadline;
  waiting_->alarm.cancel();
}

void Link::flush() {
  if (error_ || !in_flight_.empty() || outgoing_.empty()) return;
  // At once, as far as the socket takes it: the caller may be busy for a while before anything else runs.
  boost::system::error_code ignored;
  const std::size_t written = socket_.write_some(asio::buffer(outgoing_), ignored);
  outgoing_.erase(outgoing_.begin(), outgoing_.begin() + static_cast<std::ptrdiff_t>(written));
  if (outgoing_.empty()) return;
  in_flight_.swap(outgoing_);
  asio::async_write(socket_, asio::buffer(in_flight_),
                    [self = shared_from_this()](const boost::system::error_code& error, std::size_t) {
                      self->in_flight_.clear();
                      // A broken socket is reported by the reader, which may first find the reason the peer
                      // gave.
                      if (!error) self->flush();
                    });
}

// ---- the end ----

void Link::fail(LinkErrorKind kind, std::string text) {
  if (error_) return;
  error_ = LinkError{kind, std::move(text)};
  boost::system::error_code ignored;
  socket_.close(ignored);
  connect_alarm_.cancel();
  heartbeat_timer_.cancel();
  silence_timer_.cancel();
  if (established_) {
    loss_is_due_ = true;
    asio::post(executor_, [self = shared_from_this()] {
      self->loss_is_due_ = false;
      const auto on_loss =
          self->hooks_.on_loss;  // a copy: the hook may destroy the client and with it the original
      if (on_loss) on_loss(*self->error_);
    });
  }
  // Last: the loss is told before the calls end.
  if (waiting_ != nullptr) waiting_->alarm.cancel();
  if (asking_ != nullptr) asking_->alarm.cancel();
}

void Link::close() {
  hooks_ = {};
  fail(LinkErrorKind::kClosed, "closed by this side");
  loss_is_due_ = false;
}

// ---- reading ----

void Link::take(const Message& message) {
  const auto unexpected = [&] {
    fail(LinkErrorKind::kProtocol, "the controller sent " + std::string(name(type_of(message))) +
                                       " with sequence " + std::to_string(message.sequence) +
                                       ", which answers nothing that was asked");
  };
  std::visit(
      [&]<class Body>(const Body& body) {
        if constexpr (std::is_same_v<Body, State>) {
          take_state(body);
        } else if constexpr (std::is_same_v<Body, Fault>) {
          const bool is_leaving = body.code == FaultCode::kStopping;
          fail(is_leaving ? LinkErrorKind::kPeerClosed : LinkErrorKind::kFault, fault_text(body));
        } else if constexpr (std::is_same_v<Body, Permit>) {
          if (!take_permit(body)) unexpected();
        } else if constexpr (std::is_same_v<Body, Accepted>) {
          if (waiting_ == nullptr || waiting_->sequence != message.sequence) return unexpected();
          take_acceptance();
        } else if constexpr (std::is_constructible_v<Answer, const Body&>) {
          if (!take_answer(message.sequence, body)) unexpected();
        } else {
          unexpected();
        }
      },
      message.payload);
}

void Link::take_state(const State& state) {
  if (state.session != welcome_.session) {
    fail(LinkErrorKind::kProtocol, "the controller's session changed from " +
                                       std::to_string(welcome_.session) + " to " +
                                       std::to_string(state.session) + " within a connection");
    return;
  }
  latest_state_ = state;
  send_heartbeat();  // a controller whose time runs faster than this host's waits for it
  watch_command(state);
  const auto on_state = hooks_.on_state;  // a copy, as for on_loss
  if (on_state) on_state(state);
}

/// Also told again for a command that was asked for and still runs.
void Link::take_acceptance() {
  waiting_->accepted = true;
  waiting_->is_asked_for = false;
  waiting_->idle_since.reset();
  waiting_->settle_by.reset();
  if (waiting_->is_stopped) waiting_->settle_by = Clock::now() + options_.answer_deadline;
  waiting_->alarm.cancel();
}

/// The command that is waited for runs as long as State says so; behind that its result is on its way, or
/// lost.
void Link::watch_command(const State& state) {
  if (waiting_ == nullptr || waiting_->done || !waiting_->accepted) return;
  const auto now = Clock::now();
  if (state.active_sequence == waiting_->sequence) {
    waiting_->idle_since.reset();
    if (waiting_->settle_by) waiting_->settle_by = now + options_.answer_deadline;
    return;
  }
  if (!waiting_->idle_since) waiting_->idle_since = now;
  if (waiting_->is_asked_for || now - *waiting_->idle_since < options_.result_lost_after) return;
  waiting_->is_asked_for = true;
  waiting_->settle_by = now + options_.answer_deadline;
  const ResultQuery question{waiting_->sequence};
  send(Message{0, question});
  waiting_->alarm.cancel();
}

/// A permit may be reported again and withdrawn at any time; it is granted only to a host that waits for it.
bool Link::take_permit(const Permit& permit) {
  if (!runs_begun_.contains(permit.run)) return false;
  const bool to_asking = asking_ != nullptr && !asking_->done && asking_->run == permit.run;
  if (to_asking) {
    const bool refused = permit.state == PermitState::kNone && permit.reason == PermitReason::kRefused;
    if (permit.state == PermitState::kAwaited) {
      asking_->accepted = true;
      asking_->alarm.cancel();
    } else if (asking_->accepted || refused) {
      asking_->done = true;
      asking_->decision = permit;
      asking_->alarm.cancel();
    } else if (permit.state == PermitState::kGranted) {
      return false;
    }  // else the end of an earlier permit, told before this Begin was read
  } else if (permit.state == PermitState::kGranted) {
    const bool again =
        latest_permit_ && latest_permit_->run == permit.run && latest_permit_->state == PermitState::kGranted;
    if (!again) return false;
  }
  latest_permit_ = permit;
  const auto on_permit = hooks_.on_permit;  // a copy, as for on_loss
  if (on_permit) on_permit(permit);
  return true;
}

/// Answers are matched by their sequence alone. A result that was answered before, or that ends the command
/// which was open when this connection began, may come again unasked: it is stored there until it is
/// acknowledged.
bool Link::take_answer(std::uint32_t sequence, const Answer& answer) {
  const bool is_result =
      std::holds_alternative<TouchResult>(answer) || std::holds_alternative<MoveResult>(answer);
  if (waiting_ != nullptr && waiting_->sequence == sequence && !waiting_->answer) {
    if (waiting_->is_asked_for && std::holds_alternative<ResultUnknown>(answer) && !waiting_->takes(answer)) {
      fail(LinkErrorKind::kUnanswered, waiting_->what + " was accepted, but its result is lost");
      return true;
    }
    if (!waiting_->takes(answer)) return false;
    waiting_->answer = answer;
    waiting_->done = true;
    if (is_result) last_answered_ = sequence;
    waiting_->alarm.cancel();
    return true;
  }
  return is_result && sequence != 0 && (sequence == last_answered_ || sequence == welcome_.open_sequence);
}

}  // namespace cs8
