#include "sim_controller/server.hpp"

#include <spdlog/logger.h>

#include <array>
#include <boost/asio/co_spawn.hpp>
#include <boost/asio/detached.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/redirect_error.hpp>
#include <boost/asio/steady_timer.hpp>
#include <deque>
#include <set>

#include "cs8_protocol/codec.hpp"
#include "cs8_protocol/framing.hpp"
#include "cs8_protocol/names.hpp"
#include "cs8_protocol/wire_units.hpp"

namespace sim {
namespace {

namespace asio = boost::asio;
using asio::ip::tcp;

constexpr std::chrono::milliseconds kTickPeriod{4};
/// How long a closed connection is still read, so that the last message is not lost to a reset.
constexpr std::chrono::milliseconds kLingerMax{500};
/// A State is dropped when this many frames wait to be sent.
constexpr std::size_t kStateQueueMax = 4;
/// A host that does not read is closed when this many frames wait.
constexpr std::size_t kQueueMax = 1000;
/// With those that are being turned away.
constexpr std::size_t kConnectionsMax = 50;
constexpr std::size_t kGarbageSize = 64;

struct Connection {
  explicit Connection(tcp::socket accepted) : socket(std::move(accepted)), linger(socket.get_executor()) {}

  tcp::socket socket;
  asio::steady_timer linger;
  std::deque<std::vector<std::uint8_t>> queue;  // the first is being written
  bool closing = false;                         // no more frames are taken; closed when the queue is empty
  bool silent = false;
};

using ConnectionPtr = std::shared_ptr<Connection>;

}  // namespace

class Server::Core : public std::enable_shared_from_this<Server::Core> {
 public:
  Core(asio::io_context& io, const std::string& host, std::uint16_t port, Plant plant, ServerOptions options)
      : acceptor_(io, tcp::resolver(io).resolve(host, std::to_string(port)).begin()->endpoint()),
        timer_(io),
        plant_(std::move(plant)),
        clock_(std::move(options.clock)),
        log_(std::move(options.log)),
        faults_(std::move(options.faults)),
        state_(make_controller(plant_, options.controller, clock_())) {}

  void start() {
    asio::co_spawn(acceptor_.get_executor(), accept_all(shared_from_this()), asio::detached);
    asio::co_spawn(acceptor_.get_executor(), tick_on(shared_from_this()), asio::detached);
  }

  [[nodiscard]] std::uint16_t port() const { return port_; }

  void stop() {
    boost::system::error_code ignored;
    stopped_ = true;
    acceptor_.close(ignored);
    timer_.cancel();
    for (const ConnectionPtr& connection : connections_) close_now(*connection);
  }

 private:
  // Each coroutine holds the core, so that it may end after the Server object.

  static asio::awaitable<void> accept_all(std::shared_ptr<Core> self) {
    while (!self->stopped_) {
      boost::system::error_code error;
      tcp::socket socket(self->acceptor_.get_executor());
      co_await self->acceptor_.async_accept(socket, asio::redirect_error(asio::use_awaitable, error));
      if (error == asio::error::operation_aborted || self->stopped_) co_return;
      if (!error) self->take(std::move(socket));
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
      while (!connection->closing) {
        const cs8::DecodeResult frame = co_await cs8::read_frame(connection->socket);
        if (connection->closing) break;
        if (const auto* message = std::get_if<cs8::Message>(&frame)) {
          self->receive(connection, *message);
        } else {
          self->refuse(connection, cs8::fault_for(std::get<cs8::DecodeError>(frame)));
        }
      }
      // What still comes is read and forgotten: closing on unread bytes would take the last message from the
      // host.
      std::array<std::uint8_t, 4096> bytes{};
      for (;;) co_await connection->socket.async_read_some(asio::buffer(bytes), asio::use_awaitable);
    } catch (const boost::system::system_error&) {
      // The host, kLingerMax or stop() ended it.
    }
    self->release(connection);
    close_now(*connection);
    self->connections_.erase(connection);
  }

  /// Takes no more frames and ends the connection once the queue is sent and the host has closed, or after
  /// kLingerMax. The place is free for another host at once.
  void begin_close(const ConnectionPtr& connection) {
    if (connection->closing) return;
    connection->closing = true;
    release(connection);
    if (connection->queue.empty()) end_sending(*connection);
    connection->linger.expires_after(kLingerMax);
    connection->linger.async_wait([connection](boost::system::error_code error) {
      if (!error) close_now(*connection);
    });
  }

  static void end_sending(Connection& connection) {
    boost::system::error_code ignored;
    connection.socket.shutdown(tcp::socket::shutdown_send, ignored);
  }

  static void close_now(Connection& connection) {
    boost::system::error_code ignored;
    connection.linger.cancel();
    connection.socket.close(ignored);
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
    }
    asio::co_spawn(acceptor_.get_executor(), serve(shared_from_this(), connection), asio::detached);
  }

  void receive(const ConnectionPtr& connection, cs8::Message message) {
    if (const auto fault = faults_.next(cs8::type_of(message))) {
      if (misbehave(connection, *fault, message)) return;
    }
    handle(message);
    handle(Tick{});  // a motion that takes no time is over at once
  }

  void refuse(const ConnectionPtr& connection, const cs8::Fault& fault) {
    if (log_) log_->info("connection closed: {}", cs8::name(fault.code));
    send(connection, {0, fault});
    begin_close(connection);
  }

  void tick() {
    boost::system::error_code error;
    const bool waiting = host_ && host_->socket.available(error) > 0 && !error;
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
    if (host && replies.close) begin_close(host);
  }

  void send_with_faults(const ConnectionPtr& connection, cs8::Message message) {
    if (const auto fault = faults_.next(cs8::type_of(message))) {
      if (misbehave(connection, *fault, message)) return;
    }
    send(connection, message);
  }

  /// Does what the fault says; true when the message is lost.
  bool misbehave(const ConnectionPtr& connection, Fault fault, cs8::Message& message) {
    switch (fault) {
      case Fault::kCloseSocket:
        connection->closing = true;
        close_now(*connection);
        return true;
      case Fault::kGoSilent:
        connection->silent = true;
        return false;
      case Fault::kGarbage:
        enqueue(connection, std::vector<std::uint8_t>(kGarbageSize, 0xA5));
        return true;
      case Fault::kDrop:
        return true;
      case Fault::kWrongSequence:
        message.sequence += kSequenceOffset;
        return false;
    }
    throw std::logic_error("an unlisted fault");
  }

  void send(const ConnectionPtr& connection, const cs8::Message& message) {
    if (std::holds_alternative<cs8::State>(message.payload) && connection->queue.size() >= kStateQueueMax)
      return;
    enqueue(connection, cs8::encode(message));
  }

  void enqueue(const ConnectionPtr& connection, std::vector<std::uint8_t> bytes) {
    if (connection->silent || connection->closing) return;
    if (connection->queue.size() >= kQueueMax) {
      connection->closing = true;
      return close_now(*connection);
    }
    connection->queue.push_back(std::move(bytes));
    if (connection->queue.size() == 1) write_first(connection);
  }

  static void write_first(const ConnectionPtr& connection) {
    asio::async_write(connection->socket, asio::buffer(connection->queue.front()),
                      [connection](boost::system::error_code error, std::size_t) {
                        if (error) return close_now(*connection);
                        connection->queue.pop_front();
                        if (!connection->queue.empty()) {
                          write_first(connection);
                        } else if (connection->closing) {
                          end_sending(*connection);
                        }
                      });
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
  std::uint16_t port_ = acceptor_.local_endpoint().port();
  Plant plant_;
  std::function<TimePoint()> clock_;
  std::shared_ptr<spdlog::logger> log_;
  FaultPlan faults_;
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

}  // namespace sim
