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

/// The same the other way about: what parse_endpoint() takes, and what stands in a URL.
std::string endpoint_text(const Endpoint& endpoint);

}  // namespace cell
