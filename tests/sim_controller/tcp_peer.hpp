#pragma once

#include <array>
#include <boost/asio/buffer.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <cstdint>
#include <string>
#include <string_view>

namespace sim::testing {

/// The other program at a socket of an application; no call waits, but for connecting to who listens.
class TcpPeer {
 public:
  using tcp = boost::asio::ip::tcp;

  TcpPeer(boost::asio::io_context& io, std::uint16_t port, int receive_buffer = 0) : socket_(io) {
    socket_.open(tcp::v4());
    if (receive_buffer > 0) socket_.set_option(boost::asio::socket_base::receive_buffer_size(receive_buffer));
    socket_.connect({boost::asio::ip::address_v4::loopback(), port});
    socket_.non_blocking(true);
  }
  explicit TcpPeer(tcp::socket accepted) : socket_(std::move(accepted)) { socket_.non_blocking(true); }

  /// How many of them there was room for.
  std::size_t write(std::string_view bytes) {
    boost::system::error_code full;
    return socket_.write_some(boost::asio::buffer(bytes.data(), bytes.size()), full);
  }
  /// All that has come up to now.
  const std::string& received() {
    std::array<char, 65536> bytes{};
    boost::system::error_code error;
    while (!error) received_.append(bytes.data(), socket_.read_some(boost::asio::buffer(bytes), error));
    if (error != boost::asio::error::would_block) has_ended_ = true;
    return received_;
  }
  /// The other side has ended the connection.
  bool has_ended() {
    received();
    return has_ended_;
  }

  void end_sending() { socket_.shutdown(tcp::socket::shutdown_send); }
  void close() { socket_.close(); }
  /// As a program that crashes may leave it: what is under way is lost.
  void reset() {
    socket_.set_option(boost::asio::socket_base::linger(true, 0));
    socket_.close();
  }

 private:
  tcp::socket socket_;
  std::string received_;
  bool has_ended_ = false;
};

}  // namespace sim::testing
