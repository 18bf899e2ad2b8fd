#pragma once

#include <gtest/gtest.h>
#include <sys/socket.h>
#include <sys/time.h>

#include <boost/asio/buffer.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/read.hpp>
#include <boost/asio/read_until.hpp>
#include <boost/asio/write.hpp>
#include <charconv>
#include <map>
#include <optional>
#include <string>
#include <utility>

namespace cell {

/// An answer as its bytes say it is; header names in lower case.
struct RawAnswer {
  unsigned status = 0;  // 0: the connection ended without one
  std::map<std::string, std::string> header;
  std::string body;
};

/// A client that sends the bytes it is given, whatever they are, and waits for answers. Gives up after
/// kPatience, so that a server that does not answer fails a test and does not hang it.
class RawClient {
 public:
  /// `from`: another address of this machine than the system takes, of which all of 127.0.0.0/8 are.
  explicit RawClient(const boost::asio::ip::tcp::endpoint& server,
                     const std::optional<boost::asio::ip::address_v4>& from = {}) {
    socket_.open(server.protocol());
    if (from) socket_.bind({*from, 0});
    socket_.connect(server);
    // Blocking reads of Asio wait without end: the socket's own limit ends them.
    const timeval patience{.tv_sec = kPatienceSeconds};
    ::setsockopt(socket_.native_handle(), SOL_SOCKET, SO_RCVTIMEO, &patience, sizeof patience);
  }

  void send(const std::string& bytes) {
    boost::system::error_code ignored;  // a server that has refused already may have closed
    boost::asio::write(socket_, boost::asio::buffer(bytes), ignored);
  }
  void send_no_more() { socket_.shutdown(boost::asio::ip::tcp::socket::shutdown_send); }

  /// The next answer; without a body when it answers a HEAD.
  RawAnswer receive(bool to_head = false) {
    std::size_t end = 0;
    while ((end = received_.find("\r\n\r\n")) == std::string::npos) {
      if (!read_some()) return {};
    }
    RawAnswer answer = parse(received_.substr(0, end + 2));
    received_.erase(0, end + 4);
    const std::size_t size =
        to_head || answer.status == 304 ? 0 : std::stoul("0" + answer.header["content-length"]);
    while (received_.size() < size) {
      if (!read_some()) return {};
    }
    answer.body = received_.substr(0, size);
    received_.erase(0, size);
    return answer;
  }

  /// What comes next, up to `end` and with it; less when the connection ends.
  std::string receive_until(const std::string& end) {
    std::size_t found = 0;
    while ((found = received_.find(end)) == std::string::npos) {
      if (!read_some()) return std::exchange(received_, {});
    }
    const std::string text = received_.substr(0, found + end.size());
    received_.erase(0, text.size());
    return text;
  }

  /// Waits for the server to end the connection; false when it says more or does not end it.
  bool closed() { return received_.empty() && !read_some() && ended_; }

 private:
  static constexpr int kPatienceSeconds = 10;

  bool read_some() {
    char bytes[4096];
    const ssize_t count = ::recv(socket_.native_handle(), bytes, sizeof bytes, 0);
    ended_ = count == 0;
    if (count > 0) received_.append(bytes, static_cast<std::size_t>(count));
    return count > 0;
  }

  static RawAnswer parse(const std::string& text) {
    RawAnswer answer;
    std::size_t line = text.find("\r\n");
    EXPECT_TRUE(text.starts_with("HTTP/1.")) << text;
    answer.status = static_cast<unsigned>(std::stoul(text.substr(9, 3)));
    while (line + 2 < text.size()) {
      const std::size_t begin = line + 2;
      line = text.find("\r\n", begin);
      const std::size_t colon = text.find(": ", begin);
      std::string name = text.substr(begin, colon - begin);
      for (char& c : name) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
      answer.header[name] = text.substr(colon + 2, line - colon - 2);
    }
    return answer;
  }

  boost::asio::io_context context_;
  boost::asio::ip::tcp::socket socket_{context_};
  std::string received_;
  bool ended_ = false;
};

}  // namespace cell
