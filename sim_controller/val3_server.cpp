#include "sim_controller/val3_server.hpp"

#include <spdlog/logger.h>

#include <algorithm>
#include <array>
#include <boost/asio/co_spawn.hpp>
#include <boost/asio/detached.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/post.hpp>
#include <boost/asio/redirect_error.hpp>
#include <boost/asio/steady_timer.hpp>
#include <boost/asio/use_awaitable.hpp>
#include <set>

#include "cs8_protocol/codec.hpp"
#include "sim_controller/connection.hpp"
#include "sim_controller/controller.hpp"
#include "sim_controller/frame_stream.hpp"
#include "sim_controller/jog.hpp"
#include "sim_controller/val3_pace.hpp"

namespace sim {
namespace {

namespace asio = boost::asio;
using asio::ip::tcp;

/// Ticks between two looks at the sockets.
constexpr int kTicksInARowMax = 25;
/// And no longer than this: lines may be slow, as those that move a hundred thousand elements.
constexpr std::chrono::milliseconds kInARowMax{20};
/// Between two looks at a program that does not read, and two tries to listen again.
constexpr std::chrono::milliseconds kUnreadRetry{4};
constexpr std::chrono::milliseconds kReopenRetry{100};
/// With those that are being closed.
constexpr std::size_t kHostsMax = 20;
/// Of what a host sent and the program has not read.
constexpr std::size_t kUnreadMax = 65'536;

using HostConnection = std::shared_ptr<Connection>;

}  // namespace

class Val3Server::Core : public std::enable_shared_from_this<Val3Server::Core> {
 public:
  Core(asio::io_context& io, const std::string& host, std::uint16_t port, Plant plant,
       const val3::Application& application, Val3ServerOptions options, val3::Findings& findings)
      : acceptor_(io, tcp::resolver(io).resolve(host, std::to_string(port)).begin()->endpoint()),
        timer_(io),
        refuse_timer_(io),
        clock_(std::move(options.clock)),
        log_(std::move(options.log)),
        controller_(std::move(plant), application, std::move(options.controller), findings),
        pace_(options.speed, clock_()) {}

  void start() {
    asio::co_spawn(acceptor_.get_executor(), accept_all(shared_from_this()), asio::detached);
    asio::co_spawn(acceptor_.get_executor(), tick_on(shared_from_this()), asio::detached);
  }

  void stop() {
    boost::system::error_code ignored;
    stopped_ = true;
    acceptor_.close(ignored);
    timer_.cancel();
    refuse_timer_.cancel();
    for (const HostConnection& connection : connections_) connection->close_now();
  }

  /// A fault, a jog: what is under way may have changed.
  void wake() { timer_.cancel(); }

  [[nodiscard]] std::uint16_t port() const { return endpoint_.port(); }
  [[nodiscard]] Val3Controller& controller() { return controller_; }

 private:
  // Each coroutine holds the core, so that it may end after the Val3Server object.

  static asio::awaitable<void> accept_all(std::shared_ptr<Core> self) {
    while (!self->stopped_) {
      boost::system::error_code error;
      tcp::socket socket(self->acceptor_.get_executor());
      co_await self->acceptor_.async_accept(socket, asio::redirect_error(asio::use_awaitable, error));
      if (self->stopped_) co_return;
      if (!error) self->take(std::move(socket));
      while (!self->stopped_ && !self->acceptor_.is_open()) co_await self->listen_again();
    }
  }

  /// After kRefuse.
  asio::awaitable<void> listen_again() {
    boost::system::error_code error;
    co_await refuse_timer_.async_wait(asio::redirect_error(asio::use_awaitable, error));
    if (stopped_ || std::chrono::steady_clock::now() < refuse_timer_.expiry()) co_return;
    try {
      acceptor_ = tcp::acceptor(acceptor_.get_executor(), endpoint_);
    } catch (const boost::system::system_error&) {
      refuse_timer_.expires_after(kReopenRetry);  // somebody else has taken the port
    }
  }

  static asio::awaitable<void> tick_on(std::shared_ptr<Core> self) {
    while (!self->stopped_) {
      boost::system::error_code error;
      if (self->advance()) {
        co_await asio::post(self->acceptor_.get_executor(), asio::use_awaitable);
      } else {
        self->timer_.expires_at(self->pace_.wake_at());
        co_await self->timer_.async_wait(asio::redirect_error(asio::use_awaitable, error));
      }
    }
  }

  /// Ticks that are due. True when more may be due at once, behind a look at the sockets.
  bool advance() {
    const auto end = clock_() + kInARowMax;
    for (int i = 0; i < kTicksInARowMax && clock_() < end; ++i) {
      if (!pace_.tick(controller_.is_busy(), controller_.clock_s(), clock_())) return false;
      tick();
      if (sent_) break;
    }
    sent_ = false;
    return true;
  }

  void tick() {
    feed_program();
    const Val3Controller::Brought brought = controller_.tick();
    if (log_) {
      for (const std::string& line : brought.told) log_->info("{}", line);
    }
    take_output();
    apply_to_connection(brought.link_faults);
    if (host_ && (channel() == nullptr || channel()->peer() == Val3Channel::Peer::kNone)) end(host_);
    if (waiting_ && try_to_connect(waiting_)) waiting_.reset();
  }

  // ---- connections ----

  Val3Channel* channel() { return controller_.host_channel(); }

  void take(tcp::socket socket) {
    boost::system::error_code ignored;
    socket.set_option(tcp::no_delay(true), ignored);
    if (connections_.size() >= kHostsMax) return;
    auto connection = std::make_shared<Connection>(std::move(socket));
    connections_.insert(connection);
    asio::co_spawn(acceptor_.get_executor(), serve(shared_from_this(), connection), asio::detached);
    if (try_to_connect(connection)) return;
    // A program that has not cleared its last connection yet, or not begun to listen, gets one more chance.
    if (!host_ && !waiting_) {
      waiting_ = connection;
    } else {
      connection->begin_close();
    }
  }

  bool try_to_connect(const HostConnection& connection) {
    if (host_ || connection->closing() || channel() == nullptr || !channel()->accept()) return false;
    host_ = connection;
    received_.reset();
    sent_frames_.reset();
    unread_.clear();
    pace_.host_connected(controller_.clock_s(), clock_());
    apply_to_connection(controller_.plan().faults_at_connection());
    wake();
    return true;
  }

  static asio::awaitable<void> serve(std::shared_ptr<Core> self, HostConnection connection) {
    std::array<std::uint8_t, 4096> bytes{};
    try {
      for (;;) {
        while (self->unread_.size() > kUnreadMax && self->host_ == connection) co_await self->unread_wait();
        if (connection->half_open()) co_await connection->left_alone();
        const std::size_t size =
            co_await connection->socket.async_read_some(asio::buffer(bytes), asio::use_awaitable);
        if (connection->half_open()) co_await connection->left_alone();
        self->receive(connection, std::span(bytes).first(size));
      }
    } catch (const boost::system::system_error&) {
      // The host, a linger time or stop() ended it.
    }
    self->release(connection);
    connection->close_now();
    self->connections_.erase(connection);
  }

  asio::awaitable<void> unread_wait() {
    asio::steady_timer wait(acceptor_.get_executor(), kUnreadRetry);
    co_await wait.async_wait(asio::use_awaitable);
  }

  /// The host is gone; what it had sent can still be read.
  void release(const HostConnection& connection) {
    if (waiting_ == connection) waiting_.reset();
    if (host_ != connection) return;
    host_.reset();
    give(received_.take_rest());
    feed_program();
    if (channel() != nullptr) channel()->leave();
    pace_.host_left();
    wake();
  }

  /// The program has closed it, or a fault does.
  void end(HostConnection connection) {
    if (host_ == connection) host_.reset();
    pace_.host_left();
    connection->begin_close();
  }

  // ---- from the host to the program ----

  void receive(const HostConnection& connection, std::span<const std::uint8_t> bytes) {
    if (host_ != connection) return;
    pace_.host_heard(controller_.clock_s(), clock_());
    for (FrameStream::Piece& piece : received_.feed(bytes)) {
      if (host_ != connection || connection->half_open()) break;
      if (piece.message) {
        receive_message(connection, *piece.message);
      } else {
        give(piece.bytes);
      }
    }
    wake();
  }

  void receive_message(const HostConnection& connection, cs8::Message message) {
    if (const auto* hello = std::get_if<cs8::Hello>(&message.payload))
      pace_.set_heartbeat_timeout(std::clamp(std::chrono::milliseconds(hello->heartbeat_timeout_ms),
                                             kHeartbeatTimeoutMin, kHeartbeatTimeoutMax));
    for (const LinkFault& fault : controller_.plan().faults_at(cs8::type_of(message))) {
      if (target_of(fault.kind) == FaultTarget::kConnection) {
        apply_to_connection({fault});
        if (connection->closing() || connection->half_open() || fault.kind == Fault::kGarbage) return;
      }
      if (fault.kind == Fault::kDrop) return;
      if (fault.kind == Fault::kDelay)
        return connection->later(fault.seconds, [this, connection, message] {
          if (host_ == connection) pass_on(message);
        });
      if (fault.kind == Fault::kDuplicate) pass_on(message);
      alter_message(fault.kind, message, last_result_);
    }
    pass_on(message);
  }

  void pass_on(const cs8::Message& message) {
    controller_.note_received(message);
    give(cs8::encode(message));
    wake();
  }

  void give(const std::vector<std::uint8_t>& bytes) {
    unread_.insert(unread_.end(), bytes.begin(), bytes.end());
  }

  void feed_program() {
    if (unread_.empty() || channel() == nullptr) return;
    const std::size_t taken = channel()->give(unread_);
    unread_.erase(unread_.begin(), unread_.begin() + static_cast<std::ptrdiff_t>(taken));
  }

  // ---- from the program to the host ----

  void take_output() {
    if (channel() == nullptr) return;
    const std::vector<std::uint8_t> bytes = channel()->take();
    if (bytes.empty() || !host_) return;
    sent_ = true;
    const HostConnection host = host_;
    for (FrameStream::Piece& piece : sent_frames_.feed(bytes)) {
      if (piece.message) {
        controller_.note_sent(*piece.message);
        send_message(host, *piece.message);
      } else {
        host->send(std::move(piece.bytes), false);
      }
    }
  }

  void send_message(const HostConnection& host, cs8::Message message) {
    const bool is_state = std::holds_alternative<cs8::State>(message.payload);
    const std::vector<LinkFault> faults = controller_.plan().faults_at(cs8::type_of(message));
    // A result that was made wrong is the one that the controller has, whoever asks again.
    if (altered_ && altered_->sequence == message.sequence &&
        cs8::type_of(*altered_) == cs8::type_of(message))
      message = *altered_;
    for (const LinkFault& fault : faults) {
      alter_message(fault.kind, message, last_result_);
      if (target_of(fault.kind) == FaultTarget::kResult) altered_ = message;
      if (fault.kind != Fault::kCloseSocket && fault.kind != Fault::kGarbage) apply_to_connection({fault});
    }
    if (const auto* result = std::get_if<cs8::TouchResult>(&message.payload)) last_result_ = *result;
    std::vector<std::uint8_t> frame = cs8::encode(message);
    for (const LinkFault& fault : faults) alter_frame(fault.kind, frame);
    host->send_with(faults, std::move(frame), is_state);
  }

  void apply_to_connection(const std::vector<LinkFault>& faults) {
    for (const LinkFault& fault : faults) {
      if (fault.kind == Fault::kRefuse) stop_listening(fault.seconds);
      if (const HostConnection host = host_) host->meet(fault);
    }
  }

  void stop_listening(double seconds) {
    boost::system::error_code ignored;
    refuse_timer_.expires_after(
        std::chrono::duration_cast<std::chrono::nanoseconds>(std::chrono::duration<double>(seconds)));
    acceptor_.close(ignored);
  }

  tcp::acceptor acceptor_;
  asio::steady_timer timer_;
  asio::steady_timer refuse_timer_;
  tcp::endpoint endpoint_ = acceptor_.local_endpoint();
  std::function<std::chrono::steady_clock::time_point()> clock_;
  std::shared_ptr<spdlog::logger> log_;
  Val3Controller controller_;
  Val3Pace pace_;
  FrameStream received_;
  FrameStream sent_frames_;
  std::vector<std::uint8_t> unread_;  // by the program
  std::optional<cs8::TouchResult> last_result_;
  std::optional<cs8::Message> altered_;
  HostConnection host_;     // the one that the program talks with
  HostConnection waiting_;  // for the program to be ready for it
  std::set<HostConnection> connections_;
  bool sent_ = false;  // the program has written since the last look at the sockets
  bool stopped_ = false;
};

Val3Server::Val3Server(boost::asio::io_context& io, const std::string& host, std::uint16_t port, Plant plant,
                       const val3::Application& application, Val3ServerOptions options,
                       val3::Findings& findings)
    : core_(std::make_shared<Core>(io, host, port, std::move(plant), application, std::move(options),
                                   findings)) {
  core_->start();
}

Val3Server::~Val3Server() { stop(); }

std::uint16_t Val3Server::port() const { return core_->port(); }
void Val3Server::stop() { core_->stop(); }

void Val3Server::inject(const PlannedFault& fault) {
  core_->controller().plan().add(fault);
  core_->wake();
}

void Val3Server::change(const cell::OperatorChange& change) {
  Operator& person = core_->controller().person();
  person.duties = cell::changed(person.duties, change);
}

std::optional<std::string> Val3Server::jog(const cell::JogOrder& order) {
  Val3Controller& controller = core_->controller();
  auto why_not = begin_jog(controller.plant(), controller.cabinet(), order);
  core_->wake();
  return why_not;
}

std::optional<std::string> Val3Server::bring_block(const std::string& place) {
  auto why_not = core_->controller().bring_block(place);
  core_->wake();
  return why_not;
}

cs8::State Val3Server::report() const { return core_->controller().report(); }

}  // namespace sim
