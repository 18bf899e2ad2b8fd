#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <variant>

namespace bench {

/// Where a daemon listens: a port of 127.0.0.1, or its Unix socket.
using DaemonAddress = std::variant<std::uint16_t, std::filesystem::path>;

struct PlainAnswer {
  int status = 0;  // 0: the connection ended, or kAnswerPatienceMs went by, without a whole answer
  std::string body;
};

inline constexpr int kAnswerPatienceMs = 60'000;

/// A new connection, blocking; its descriptor, or -1. The kernel makes a TCP one before the daemon takes it.
int connect_to(const DaemonAddress& address);
/// False when the other side is gone.
bool send_all(int descriptor, const std::string& bytes);
/// The next answer on a connection that was asked for one.
PlainAnswer receive_answer(int descriptor);
/// Ends the connection without leaving its port in TIME_WAIT, so that tens of thousands can follow each
/// other.
void end_connection(int descriptor);

/// A request with the `Host` that `daemon` listens as; `lines` are further header lines, each with its line
/// break. A `body` is JSON.
std::string request_text(const DaemonAddress& daemon, const std::string& method, const std::string& target,
                         const std::string& lines = "", const std::string& body = "");

/// One request on a connection of its own.
PlainAnswer ask(const DaemonAddress& address, const std::string& request);

}  // namespace bench
