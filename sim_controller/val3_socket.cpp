#include "sim_controller/val3_socket.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <array>
#include <boost/asio/connect.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <optional>
#include <span>
#include <utility>

#include "config/endpoint.hpp"
#include "sim_controller/val3_channels.hpp"
#include "sim_controller/val3_stream.hpp"

namespace sim {
namespace {

namespace asio = boost::asio;
using asio::ip::tcp;

/// Clients that are looked at in one exchange.
constexpr int kAcceptsMax = 16;

/// What servers and clients have in common: the connection and the bytes.
class ChannelSocket : public Val3Socket {
 public:
  ChannelSocket(Val3Channel& channel, Tell tell) : channel_(channel), tell_(std::move(tell)) {}

  void exchange(TimePoint now) final {
    if (peer_) write();
    if (peer_ && channel_.peer() == Val3Channel::Peer::kNone) {
      tell("the application closes the connection");
      let_go(now);
    }
    if (peer_) read();
    if (!is_over_) look_for_peer(now);
    endings_.proceed(now);
  }

  void end(TimePoint now) override {
    is_over_ = true;
    if (!peer_) return;
    write();
    let_go(now);
  }

  [[nodiscard]] bool is_open() const final { return peer_.has_value() || !endings_.empty(); }

  [[nodiscard]] std::string summary() const final {
    if (!channel_.is_active())
      return fmt::format("{} at {}: the application has not used it", channel_.link(), place());
    return fmt::format("{} at {}: connections {}, bytes received {}, bytes sent {}", channel_.link(), place(),
                       count_.connections, count_.received, count_.sent);
  }

 protected:
  /// A new connection, if one is to be had.
  virtual void look_for_peer(TimePoint now) = 0;
  /// "127.0.0.1:5000"
  [[nodiscard]] virtual std::string place() const = 0;

  [[nodiscard]] Val3Channel& channel() { return channel_; }
  void tell(const std::string& text) { tell_(channel_.link() + ": " + text); }
  [[nodiscard]] bool has_peer() const { return peer_.has_value(); }
  /// Its end was seen, and the program has not closed yet.
  [[nodiscard]] bool peer_has_ended() const { return peer_ && peer_->has_ended; }

  void take(Val3Stream stream) {
    if (!channel_.accept()) return;
    stream.set_nagle(channel_.nagle());
    tell(stream.peer() + " is connected");
    ++count_.connections;
    peer_.emplace(Peer{std::move(stream)});
    read();
  }
  /// While there is a peer.
  void turn_away(Val3Stream stream, TimePoint now) {
    if (!std::exchange(peer_->has_rivals, true))
      tell("a second client, " + stream.peer() +
           ", is turned away, as are more of them; close the first one");
    endings_.add(std::move(stream), now + kEndMax);
  }

 private:
  struct Peer {
    Val3Stream stream;
    bool has_ended = false;   // nothing more comes
    bool is_lost = false;     // and nothing can be sent
    bool has_rivals = false;  // that is told once
  };

  void write() {
    if (peer_->is_lost) return;
    if (!peer_->stream.has_unsent()) peer_->stream.add(channel_.take());
    boost::system::error_code error;
    count_.sent += peer_->stream.write(error);
    if (error) lose(error);
  }

  void read() {
    std::array<std::uint8_t, 4096> bytes{};
    while (!peer_->has_ended && channel_.room() > 0) {
      boost::system::error_code error;
      const auto into = std::span(bytes).first(std::min(bytes.size(), channel_.room()));
      const std::size_t size = peer_->stream.read(into, error);
      if (error == asio::error::eof) peer_->has_ended = true;
      if (error && error != asio::error::eof) return lose(error);
      if (size == 0) break;
      channel_.give(into.first(size));
      count_.received += size;
    }
    if (peer_->has_ended && channel_.waiting() == 0 && channel_.peer() == Val3Channel::Peer::kConnected) {
      tell("the peer has closed the connection");
      channel_.leave();
    }
  }

  void lose(const boost::system::error_code& error) {
    if (channel_.peer() == Val3Channel::Peer::kConnected) tell("the connection is lost: " + error.message());
    peer_->has_ended = true;
    peer_->is_lost = true;
    channel_.leave();
  }

  /// This side closes.
  void let_go(TimePoint now) {
    if (!peer_->is_lost) {
      peer_->stream.add(channel_.take());
      endings_.add(std::move(peer_->stream), now + kEndMax);
    }
    peer_.reset();
  }

  Val3Channel& channel_;
  Tell tell_;
  std::optional<Peer> peer_;
  Val3EndingStreams endings_;
  bool is_over_ = false;
  struct {
    std::uint64_t connections = 0;
    std::uint64_t received = 0;
    std::uint64_t sent = 0;
  } count_;
};

class ServerSocket final : public ChannelSocket {
 public:
  ServerSocket(asio::io_context& io, Val3Channel& channel, std::uint16_t port, Tell tell)
      : ChannelSocket(channel, std::move(tell)), acceptor_(io) {
    boost::system::error_code error;
    endpoint_ = {asio::ip::address_v4::loopback(), port};
    acceptor_.open(endpoint_.protocol(), error);
    if (!error) acceptor_.set_option(asio::socket_base::reuse_address(true), error);
    if (!error) acceptor_.bind(endpoint_, error);
    if (!error) acceptor_.non_blocking(true, error);
    if (error) refuse(error);
    endpoint_ = acceptor_.local_endpoint();
  }

  void end(TimePoint now) override {
    boost::system::error_code ignored;
    acceptor_.close(ignored);
    waiting_.reset();
    ChannelSocket::end(now);
  }
  [[nodiscard]] std::uint16_t port() const override { return endpoint_.port(); }

 private:
  [[nodiscard]] std::string place() const override { return address_text(endpoint_); }

  void look_for_peer(TimePoint now) override {
    if (!listens()) return;
    if (waiting_ && !has_peer()) take(*std::exchange(waiting_, std::nullopt));
    for (int i = 0; i < kAcceptsMax; ++i) {
      boost::system::error_code error;
      tcp::socket socket(acceptor_.get_executor());
      acceptor_.accept(socket, error);
      if (error) return;  // nobody is there, or this process has no more sockets: later, then
      Val3Stream client(std::move(socket));
      if (!has_peer()) {
        take(std::move(client));
      } else if (peer_has_ended() && !waiting_) {
        waiting_.emplace(std::move(client));
      } else {
        turn_away(std::move(client), now);
      }
    }
  }

  /// From the program's first use on (manual 6, page 61).
  bool listens() {
    if (listens_ || !channel().is_active()) return listens_;
    boost::system::error_code error;
    acceptor_.listen(asio::socket_base::max_listen_connections, error);
    if (error) refuse(error);
    listens_ = true;
    tell("listening on " + place());
    return true;
  }

  [[noreturn]] void refuse(const boost::system::error_code& error) {
    throw SocketRefusal(
        fmt::format("{}: cannot listen on {}: {}; give another port with --socket, or 0 for any free one",
                    channel().link(), address_text(endpoint_), error.message()));
  }

  tcp::acceptor acceptor_;
  tcp::endpoint endpoint_;
  bool listens_ = false;
  std::optional<Val3Stream> waiting_;  // for the program to close what has ended
};

class ClientSocket final : public ChannelSocket {
 public:
  ClientSocket(asio::io_context& io, Val3Channel& channel, const RunSocket& at, Tell tell)
      : ChannelSocket(channel, std::move(tell)),
        io_(io),
        place_(cell::endpoint_text({at.peer_host, at.port})),
        port_(at.port) {
    boost::system::error_code error;
    addresses_ = tcp::resolver(io).resolve(at.peer_host, std::to_string(at.port), error);
    if (error)
      throw SocketRefusal(fmt::format("{}: {} has no address: {}; give another host with --socket",
                                      channel.link(), at.peer_host, error.message()));
  }
  ~ClientSocket() override { give_up(); }

  void end(TimePoint now) override {
    give_up();
    ChannelSocket::end(now);
  }
  [[nodiscard]] std::uint16_t port() const override { return port_; }

 private:
  /// The handler of a connection attempt holds it, so that it may come after this socket has gone.
  struct Attempt {
    explicit Attempt(asio::io_context& io) : socket(io) {}
    tcp::socket socket;
    std::optional<boost::system::error_code> ended;
  };

  [[nodiscard]] std::string place() const override { return place_; }

  void look_for_peer(TimePoint now) override {
    if (attempt_) {
      if (attempt_->ended) conclude(now);
    } else if (channel().take_request() && !has_peer() && now >= again_at_) {
      attempt_ = std::make_shared<Attempt>(io_);
      asio::async_connect(attempt_->socket, addresses_,
                          [attempt = attempt_](const boost::system::error_code& error, const tcp::endpoint&) {
                            attempt->ended = error;
                          });
    }
  }

  void conclude(TimePoint now) {
    const std::shared_ptr<Attempt> attempt = std::exchange(attempt_, nullptr);
    if (!*attempt->ended) {
      told_.clear();
      return take(Val3Stream(std::move(attempt->socket)));
    }
    again_at_ = now + kConnectAgain;
    const std::string why =
        fmt::format("no connection to {}: {}; start the program there, or give another address with --socket",
                    place_, attempt->ended->message());
    if (std::exchange(told_, why) != why) tell(why);
  }

  void give_up() {
    boost::system::error_code ignored;
    if (attempt_) attempt_->socket.close(ignored);
    attempt_.reset();
  }

  asio::io_context& io_;
  std::string place_;
  std::uint16_t port_;
  tcp::resolver::results_type addresses_;
  std::shared_ptr<Attempt> attempt_;
  TimePoint again_at_{};
  std::string told_;  // why there was no connection, once until it is another reason
};

}  // namespace

std::unique_ptr<Val3Socket> open_socket(asio::io_context& io, Val3Channel& channel, const RunSocket& at,
                                        Val3Socket::Tell tell) {
  if (at.peer_host.empty()) return std::make_unique<ServerSocket>(io, channel, at.port, std::move(tell));
  return std::make_unique<ClientSocket>(io, channel, at, std::move(tell));
}

}  // namespace sim
