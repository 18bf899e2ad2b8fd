#include "sim_controller/connection.hpp"

#include <algorithm>
#include <boost/asio/buffer.hpp>
#include <boost/asio/redirect_error.hpp>
#include <boost/asio/use_awaitable.hpp>
#include <boost/asio/write.hpp>
#include <utility>

namespace sim {
namespace {

namespace asio = boost::asio;
using asio::ip::tcp;
using Clock = std::chrono::steady_clock;

/// How long the socket of a half-open connection is kept.
constexpr std::chrono::minutes kHalfOpenMax{1};
/// A State is dropped when this many frames wait to be sent.
constexpr std::size_t kStateQueueMax = 4;

}  // namespace

Connection::Connection(tcp::socket accepted) : socket(std::move(accepted)), linger_(socket.get_executor()) {
  boost::system::error_code ignored;
  socket.set_option(tcp::socket::send_buffer_size(kSendBufferBytes), ignored);
}

void Connection::send(std::vector<std::uint8_t> frame, bool is_state) {
  if (is_state) {
    if (queue_.size() >= kStateQueueMax || Clock::now() < states_from_) return;
  } else if (!held_.empty()) {
    return hold(std::move(frame), 0.0);
  }
  frame.insert(frame.begin(), glued_.begin(), glued_.end());
  glued_.clear();
  enqueue(std::move(frame));
}

void Connection::send_with(const std::vector<LinkFault>& faults, std::vector<std::uint8_t> frame,
                           bool is_state) {
  if (is_state && queue_.size() >= kStateQueueMax) return;
  for (const LinkFault& fault : faults) {
    if (fault.kind == Fault::kCloseSocket) return close_now();
    if (fault.kind == Fault::kHalfOpen) return go_half_open();
    if (fault.kind == Fault::kDrop) return;
    if (fault.kind == Fault::kDelay) return hold(std::move(frame), fault.seconds);
    if (fault.kind == Fault::kDuplicate) send(frame, is_state);
    if (fault.kind == Fault::kMerge) {
      glued_.insert(glued_.end(), frame.begin(), frame.end());
      return;
    }
    if (fault.kind == Fault::kByteByByte) {
      for (const std::uint8_t byte : frame) enqueue({byte});
      return;
    }
    if (fault.kind == Fault::kCloseMidFrame) {
      frame.resize(frame.size() / 2);
      enqueue(std::move(frame));
      return begin_close();
    }
  }
  send(std::move(frame), is_state);
}

void Connection::meet(const LinkFault& fault) {
  if (fault.kind == Fault::kCloseSocket) close_now();
  if (fault.kind == Fault::kHalfOpen) go_half_open();
  if (fault.kind == Fault::kGoSilent) go_silent();
  if (fault.kind == Fault::kStopStates) stop_states(fault.seconds);
  if (fault.kind == Fault::kGarbage) send(garbage(), false);
}

void Connection::stop_states(double seconds) {
  states_from_ = seconds == 0.0 ? Clock::time_point::max()
                                : Clock::now() + std::chrono::duration_cast<Clock::duration>(
                                                     std::chrono::duration<double>(seconds));
}

void Connection::go_half_open() {
  half_open_ = true;
  silent_ = true;
  linger_.expires_after(kHalfOpenMax);
  linger_.async_wait([self = shared_from_this()](boost::system::error_code error) {
    if (!error) self->close_now();
  });
}

asio::awaitable<void> Connection::left_alone() {
  boost::system::error_code woken;
  while (socket.is_open()) co_await linger_.async_wait(asio::redirect_error(asio::use_awaitable, woken));
  throw boost::system::system_error(asio::error::operation_aborted);
}

void Connection::later(double seconds, std::function<void()> act) {
  const auto timer =
      timers_.emplace(timers_.end(), socket.get_executor(),
                      std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(seconds)));
  timer->async_wait(
      [self = shared_from_this(), timer, act = std::move(act)](boost::system::error_code error) {
        self->timers_.erase(timer);
        if (!error) act();
      });
}

/// What is late is sent when the first of it is due.
void Connection::hold(std::vector<std::uint8_t> frame, double seconds) {
  const bool is_first = held_.empty();
  if (held_.size() >= kQueueMax) return close_now();
  held_.push_back(std::move(frame));
  if (!is_first) return;
  later(seconds, [this] {
    for (auto& late : std::exchange(held_, {})) send(std::move(late), false);
  });
}

void Connection::enqueue(std::vector<std::uint8_t> bytes) {
  if (silent_ || closing_) return;
  if (queue_.size() >= kQueueMax) return close_now();
  queue_.push_back(std::move(bytes));
  if (queue_.size() == 1) write_first();
}

void Connection::write_first() {
  asio::async_write(socket, asio::buffer(queue_.front()),
                    [self = shared_from_this()](boost::system::error_code error, std::size_t) {
                      if (error) return self->close_now();
                      if (self->half_open_) return;
                      self->queue_.pop_front();
                      if (!self->queue_.empty()) {
                        self->write_first();
                      } else if (self->closing_) {
                        self->end_sending();
                      }
                    });
}

void Connection::begin_close() {
  if (closing_ || half_open_) return;
  closing_ = true;
  if (queue_.empty()) end_sending();
  linger_.expires_after(kLingerMax);
  linger_.async_wait([self = shared_from_this()](boost::system::error_code error) {
    if (!error) self->close_now();
  });
}

void Connection::end_sending() {
  boost::system::error_code ignored;
  socket.shutdown(tcp::socket::shutdown_send, ignored);
}

void Connection::close_now() {
  boost::system::error_code ignored;
  closing_ = true;
  linger_.cancel();
  for (asio::steady_timer& timer : timers_) timer.cancel();
  socket.close(ignored);
}

}  // namespace sim
