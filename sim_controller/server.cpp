#include "sim_controller/server.hpp"

#include <spdlog/logger.h>

#include <array>
#include <boost/asio/co_spawn.hpp>
#include <boost/asio/detached.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/redirect_error.hpp>
#include <boost/asio/steady_timer.hpp>
#include <set>

#include "cs8_protocol/codec.hpp"
#include "cs8_protocol/framing.hpp"
#include "cs8_protocol/names.hpp"
#include "cs8_protocol/wire_units.hpp"
#include "sim_controller/connection.hpp"
#include "sim_controller/jog.hpp"
#include "sim_controller/placed_block.hpp"
#include "sim_controller/reports.hpp"

namespace sim {
namespace {

namespace asio = boost::asio;
using asio::ip::tcp;

constexpr std::chrono::milliseconds kTickPeriod{4};
/// Between two tries to listen again.
constexpr std::chrono::milliseconds kListenRetry{100};
/// With those that are being turned away.
constexpr std::size_t kConnectionsMax = 50;

using ConnectionPtr = std::shared_ptr<Connection>;

}  // namespace

class Server::Core : public std::enable_shared_from_this<Server::Core> {
 public:
  Core(asio::io_context& io, const std::string& host, std::uint16_t port, Plant plant, ServerOptions options)
      : acceptor_(io, tcp::resolver(io).resolve(host, std::to_string(port)).begin()->endpoint()),
        timer_(io),
        refuse_timer_(io),
        plant_(std::move(plant)),
        plants_(std::move(options.plants)),
        clock_(std::move(options.clock)),
        log_(std::move(options.log)),
        state_(make_controller(plant_, options.controller, clock_())) {
    state_.plan = FaultPlan(std::move(options.faults));
  }

  void start() {
    asio::co_spawn(acceptor_.get_executor(), accept_all(shared_from_this()), asio::detached);
    asio::co_spawn(acceptor_.get_executor(), tick_on(shared_from_this()), asio::detached);
  }

  [[nodiscard]] std::uint16_t port() const { return endpoint_.port(); }

  void stop() {
    boost::system::error_code ignored;
    stopped_ = true;
    acceptor_.close(ignored);
    timer_.cancel();
    refuse_timer_.cancel();
    for (const ConnectionPtr& connection : connections_) connection->close_now();
  }

  void inject(const PlannedFault& fault) { state_.plan.add(fault); }

  void change(const cell::OperatorChange& change) {
    state_.person.duties = cell::changed(state_.person.duties, change);
  }

  std::optional<std::string> jog(const cell::JogOrder& order) {
    return begin_jog(plant_, state_.cabinet, order);
  }
  std::optional<std::string> bring_block(const std::string& place) {
    return sim::bring_block(plants_, place, plant_, state_.cabinet);
  }
  [[nodiscard]] cs8::State report() const { return state_report(state_, clock_()); }

 private:
  // Each coroutine holds the core, so that it may end after the Server object.

  static asio::awaitable<void> accept_all(std::shared_ptr<Core> self) {
    while (!self->stopped_) {
      boost::system::error_code error;
      tcp::socket socket(self->acceptor_.get_executor());
      co_await self->acceptor_.async_accept(socket, asio::redirect_error(asio::use_awaitable, error));
      if (self->stopped_) co_return;
      if (!error) self->take(std::move(socket));
      if (!self->acceptor_.is_open()) co_await self->listen_again();
    }
  }

  /// After kRefuse. Somebody else may have taken the port in between: it is asked for until it is free.
  asio::awaitable<void> listen_again() {
    boost::system::error_code error;
    while (!stopped_ && !acceptor_.is_open()) {
      co_await refuse_timer_.async_wait(asio::redirect_error(asio::use_awaitable, error));
      if (stopped_ || std::chrono::steady_clock::now() < refuse_timer_.expiry()) continue;
      try {
        acceptor_ = tcp::acceptor(acceptor_.get_executor(), endpoint_);
      } catch (const boost::system::system_error&) {
        refuse_timer_.expires_after(kListenRetry);
      }
    }
  }

  static asio::awaitable<void> tick_on(std::shared_ptr<Core> self) {
    while (!self->stopped_) {
      boost::system::error_code error;
      self->timer_.expires_after(kTickPeriod);
      co_await self->timer_.async_wait(asio::redirect_error(asio::use_awaitable, error));
      if (!self->stopped_) self->tick();
    }
  }

  static asio::awaitable<void> serve(std::shared_ptr<Core> self, ConnectionPtr connection) {
    try {
      while (!connection->closing()) {
        const cs8::DecodeResult frame = co_await cs8::read_frame(connection->socket);
        if (connection->closing()) break;
        if (connection->half_open()) co_await connection->left_alone();
        if (const auto* message = std::get_if<cs8::Message>(&frame)) {
          self->receive(connection, *message);
        } else {
          self->refuse(connection, self->fault_of(connection, std::get<cs8::DecodeError>(frame)));
        }
      }
      // What still comes is read and forgotten: closing on unread bytes would take the last message from the
      // host.
      std::array<std::uint8_t, 4096> bytes{};
      for (;;) co_await connection->socket.async_read_some(asio::buffer(bytes), asio::use_awaitable);
    } catch (const boost::system::system_error&) {
      // The host, a linger time or stop() ended it.
    }
    self->release(connection);
    connection->close_now();
    self->connections_.erase(connection);
  }

  /// What a frame is refused with: before Hello any message but that one, then a message of the other side.
  [[nodiscard]] cs8::Fault fault_of(const ConnectionPtr& connection, const cs8::DecodeError& error) const {
    const bool type_is_known = error.kind != cs8::DecodeErrorKind::kBadMagic &&
                               error.kind != cs8::DecodeErrorKind::kVersion &&
                               error.kind != cs8::DecodeErrorKind::kUnknownType;
    if (!type_is_known) return cs8::fault_for(error);
    const bool greeted = connection != host_ || state_.greeted;
    if (!greeted && error.type != cs8::MessageType::kHello) return {cs8::FaultCode::kNoHandshake, 0};
    if (cs8::is_from_controller(error.type))
      return {cs8::FaultCode::kWrongSide, static_cast<std::int32_t>(error.type)};
    return cs8::fault_for(error);
  }

  /// Ends the connection behind what waits to be sent. The place is free for another host at once.
  void begin_close(const ConnectionPtr& connection) {
    release(connection);
    connection->begin_close();
  }

  void take(tcp::socket socket) {
    boost::system::error_code ignored;
    socket.set_option(tcp::no_delay(true), ignored);
    if (connections_.size() >= kConnectionsMax) return;
    auto connection = std::make_shared<Connection>(std::move(socket));
    connections_.insert(connection);
    if (host_) {
      refuse(connection, {cs8::FaultCode::kOccupied, 0});
    } else {
      host_ = connection;
      handle(ConnectionOpened{});
      apply_connection_faults(state_.plan.faults_at_connection());
    }
    asio::co_spawn(acceptor_.get_executor(), serve(shared_from_this(), connection), asio::detached);
  }

  void receive(const ConnectionPtr& connection, cs8::Message message) {
    for (const LinkFault& fault : state_.plan.faults_at(cs8::type_of(message))) {
      if (target_of(fault.kind) == FaultTarget::kConnection) {
        apply_connection_faults({fault});
        if (connection->closing() || connection->half_open() || fault.kind == Fault::kGarbage) return;
      }
      if (fault.kind == Fault::kDrop) return;
      if (fault.kind == Fault::kDelay)
        return connection->later(fault.seconds, [this, connection, message] {
          if (host_ == connection) handle(message);
        });
      if (fault.kind == Fault::kDuplicate) handle(message);
      alter_message(fault.kind, message, last_result_);
    }
    handle(message);
    handle(Tick{});  // a motion that takes no time is over at once
  }

  /// Faults of the connection, as they come.
  void apply_connection_faults(const std::vector<LinkFault>& faults) {
    for (const LinkFault& fault : faults) {
      if (fault.kind == Fault::kRefuse) stop_listening(fault.seconds);
      if (const ConnectionPtr host = host_) host->meet(fault);
    }
  }

  void stop_listening(double seconds) {
    boost::system::error_code ignored;
    refuse_timer_.expires_after(
        std::chrono::duration_cast<std::chrono::nanoseconds>(std::chrono::duration<double>(seconds)));
    acceptor_.close(ignored);
  }

  void refuse(const ConnectionPtr& connection, const cs8::Fault& fault) {
    if (log_) log_->info("connection closed: {}", cs8::name(fault.code));
    connection->send(cs8::encode({0, fault}), false);
    begin_close(connection);
  }

  void tick() {
    boost::system::error_code error;
    const bool waiting = host_ && !host_->half_open() && host_->socket.available(error) > 0 && !error;
    handle(Tick{waiting});
  }

  /// The connection is no longer the host's.
  void release(const ConnectionPtr& connection) {
    if (host_ != connection) return;
    host_.reset();
    handle(ConnectionClosed{});
  }

  void handle(const Event& event) {
    const Replies replies = step(plant_, state_, event, clock_());
    if (!replies.warning.empty() && log_) log_->warn("collision: {}; power is off", replies.warning);
    const ConnectionPtr host = host_;
    for (const cs8::Message& message : replies.messages) {
      log_result(message);
      if (host) send_with_faults(host, message);
    }
    apply_connection_faults(replies.link_faults);
    if (host && replies.close) begin_close(host);
  }

  void send_with_faults(const ConnectionPtr& connection, cs8::Message message) {
    const bool is_state = std::holds_alternative<cs8::State>(message.payload);
    const std::vector<LinkFault> faults = state_.plan.faults_at(cs8::type_of(message));
    for (const LinkFault& fault : faults) {
      alter_message(fault.kind, message, last_result_);
      // A result that is wrong is the one the controller has, whoever asks again.
      if (target_of(fault.kind) == FaultTarget::kResult) state_.stored_result = message;
      if (fault.kind != Fault::kCloseSocket && fault.kind != Fault::kGarbage)
        apply_connection_faults({fault});
    }
    if (const auto* result = std::get_if<cs8::TouchResult>(&message.payload)) last_result_ = *result;
    std::vector<std::uint8_t> frame = cs8::encode(message);
    for (const LinkFault& fault : faults) alter_frame(fault.kind, frame);
    connection->send_with(faults, std::move(frame), is_state);
  }

  void log_result(const cs8::Message& message) const {
    if (!log_) return;
    if (const auto* result = std::get_if<cs8::TouchResult>(&message.payload)) {
      log_->debug("touch {}: {}, overtravel {:.4f} mm", message.sequence, cs8::name(result->outcome),
                  cs8::metres_from_dmm(result->overtravel_dmm) * 1e3);
    }
  }

  tcp::acceptor acceptor_;
  asio::steady_timer timer_;
  asio::steady_timer refuse_timer_;
  tcp::endpoint endpoint_ = acceptor_.local_endpoint();
  Plant plant_;
  PlantByPlace plants_;
  std::function<TimePoint()> clock_;
  std::shared_ptr<spdlog::logger> log_;
  std::optional<cs8::TouchResult> last_result_;
  ControllerState state_;
  ConnectionPtr host_;                   // the one that is served
  std::set<ConnectionPtr> connections_;  // with those that are being turned away
  bool stopped_ = false;
};

Server::Server(asio::io_context& io, const std::string& host, std::uint16_t port, Plant plant,
               ServerOptions options)
    : core_(std::make_shared<Core>(io, host, port, std::move(plant), std::move(options))) {
  core_->start();
}

Server::~Server() { stop(); }

std::uint16_t Server::port() const { return core_->port(); }

void Server::stop() { core_->stop(); }

void Server::inject(const PlannedFault& fault) { core_->inject(fault); }

void Server::change(const cell::OperatorChange& change) { core_->change(change); }

std::optional<std::string> Server::jog(const cell::JogOrder& order) { return core_->jog(order); }
std::optional<std::string> Server::bring_block(const std::string& place) { return core_->bring_block(place); }
cs8::State Server::report() const { return core_->report(); }

}  // namespace sim
