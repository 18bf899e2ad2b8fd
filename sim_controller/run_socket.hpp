#pragma once

#include <cstdint>
#include <optional>
#include <string>

namespace sim {

/// A socket of a VAL3 application that is a real TCP socket while `cs8sim --run` runs it.
struct RunSocket {
  std::string name;        // the link of the application's sio, "Socket\host", or what stands behind its "\"
  std::string peer_host;   // whom the application connects to; empty: it is a server, on 127.0.0.1
  std::uint16_t port = 0;  // of a server 0: any free one

  bool operator==(const RunSocket&) const = default;
};

/// What a place is, for messages that refuse one.
inline constexpr const char* kRunSocketForm =
    "PORT for a server on 127.0.0.1 (0: any free one), HOST:PORT for a client's peer (from port 1)";

/// `place` is "5000" or "192.168.0.9:5000"; nothing when it is neither, or the name is empty.
std::optional<RunSocket> run_socket_at(const std::string& name, const std::string& place);

/// "NAME=PORT", "NAME=HOST:PORT": the same as one text, as an option has it.
std::optional<RunSocket> parse_run_socket(const std::string& text);

}  // namespace sim
