#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace cell {

/// A name under which clients reach the daemon, besides its address, or reach a proxy in front of it.
struct HostName {
  std::string name;
  /// Where they reach it: of a proxy that listens elsewhere than the daemon. Nothing: at the daemon's own
  /// port and at that of the scheme, which a client leaves out.
  std::optional<std::uint16_t> port = {};
};

/// NAME or NAME:PORT: letters, digits, hyphens and dots (RFC 1123), at most 253; a port from 1 to 65535 in
/// decimal digits. Nothing for another text.
std::optional<HostName> parse_host_name(std::string_view text);

}  // namespace cell
