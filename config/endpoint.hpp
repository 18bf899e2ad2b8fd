#pragma once

#include <cstdint>
#include <optional>
#include <string>

namespace cell {

struct Endpoint {
  std::string host;
  std::uint16_t port = 0;
};

/// "HOST:PORT", an IPv6 host in brackets; nothing when it is not that.
std::optional<Endpoint> parse_endpoint(const std::string& text);

}  // namespace cell
