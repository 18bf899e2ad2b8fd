#include "tests/benchmark/plain_http.hpp"

#include <netinet/in.h>
#include <netinet/tcp.h>
#include <poll.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <array>
#include <cstring>
#include <stdexcept>

namespace bench {
namespace {

int connect_to_port(std::uint16_t port) {
  const int descriptor = ::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
  if (descriptor < 0) throw std::runtime_error("no socket");
  sockaddr_in to{};
  to.sin_family = AF_INET;
  to.sin_port = htons(port);
  to.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  const int yes = 1;
  ::setsockopt(descriptor, IPPROTO_TCP, TCP_NODELAY, &yes, sizeof yes);
  if (::connect(descriptor, reinterpret_cast<const sockaddr*>(&to), sizeof to) == 0) return descriptor;
  ::close(descriptor);
  return -1;
}

int connect_to_file(const std::filesystem::path& file) {
  const int descriptor = ::socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0);
  if (descriptor < 0) throw std::runtime_error("no socket");
  sockaddr_un to{};
  to.sun_family = AF_UNIX;
  if (file.string().size() >= sizeof to.sun_path) throw std::runtime_error("too long: " + file.string());
  std::memcpy(to.sun_path, file.c_str(), file.string().size());
  if (::connect(descriptor, reinterpret_cast<const sockaddr*>(&to), sizeof to) == 0) return descriptor;
  ::close(descriptor);
  return -1;
}

/// Bytes of the answer's body; of an answer without a length none.
std::size_t body_size(const std::string& header) {
  constexpr std::string_view kName = "Content-Length: ";
  const std::size_t at = header.find(kName);
  return at == header.npos ? 0 : std::stoul(header.substr(at + kName.size(), 12));
}

}  // namespace

int connect_to(const DaemonAddress& address) {
  if (const auto* port = std::get_if<std::uint16_t>(&address)) return connect_to_port(*port);
  return connect_to_file(std::get<std::filesystem::path>(address));
}

bool send_all(int descriptor, const std::string& bytes) {
  std::size_t sent = 0;
  while (sent < bytes.size()) {
    const ssize_t count = ::send(descriptor, bytes.data() + sent, bytes.size() - sent, MSG_NOSIGNAL);
    if (count <= 0) return false;
    sent += static_cast<std::size_t>(count);
  }
  return true;
}

PlainAnswer receive_answer(int descriptor) {
  std::string received;
  std::size_t whole = std::string::npos;
  while (received.size() < whole) {
    pollfd readable{descriptor, POLLIN, 0};
    if (::poll(&readable, 1, kAnswerPatienceMs) <= 0) return {};
    std::array<char, 16'384> bytes{};
    const ssize_t count = ::recv(descriptor, bytes.data(), bytes.size(), 0);
    if (count <= 0) return {};
    received.append(bytes.data(), static_cast<std::size_t>(count));
    const std::size_t end = received.find("\r\n\r\n");
    if (whole == std::string::npos && end != received.npos)
      whole = end + 4 + body_size(received.substr(0, end + 2));
  }
  return {std::stoi(received.substr(9, 3)), received.substr(received.find("\r\n\r\n") + 4)};
}

void end_connection(int descriptor) {
  const linger at_once{.l_onoff = 1, .l_linger = 0};
  ::setsockopt(descriptor, SOL_SOCKET, SO_LINGER, &at_once, sizeof at_once);
  ::close(descriptor);
}

std::string request_text(const DaemonAddress& daemon, const std::string& method, const std::string& target,
                         const std::string& lines, const std::string& body) {
  const auto* port = std::get_if<std::uint16_t>(&daemon);
  const std::string host = port ? "127.0.0.1:" + std::to_string(*port) : "localhost";
  std::string text = method + ' ' + target + " HTTP/1.1\r\nHost: " + host + "\r\n" + lines;
  if (!body.empty())
    text += "Content-Type: application/json\r\nContent-Length: " + std::to_string(body.size()) + "\r\n";
  return text + "\r\n" + body;
}

PlainAnswer ask(const DaemonAddress& address, const std::string& request) {
  const int descriptor = connect_to(address);
  if (descriptor < 0) return {};
  PlainAnswer answer;
  if (send_all(descriptor, request)) answer = receive_answer(descriptor);
  end_connection(descriptor);
  return answer;
}

}  // namespace bench
