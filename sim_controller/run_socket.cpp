#include "sim_controller/run_socket.hpp"

#include <charconv>

#include "config/endpoint.hpp"

namespace sim {

std::optional<RunSocket> run_socket_at(const std::string& name, const std::string& place) {
  if (name.empty()) return std::nullopt;
  if (place.find(':') == std::string::npos) {
    RunSocket server{.name = name, .peer_host = {}, .port = 0};
    const char* const end = place.data() + place.size();
    const auto [rest, error] = std::from_chars(place.data(), end, server.port);
    if (error != std::errc{} || rest != end) return std::nullopt;
    return server;
  }
  const auto peer = cell::parse_endpoint(place);
  if (!peer || peer->port == 0) return std::nullopt;
  return RunSocket{.name = name, .peer_host = peer->host, .port = peer->port};
}

std::optional<RunSocket> parse_run_socket(const std::string& text) {
  const std::size_t equals = text.rfind('=');  // a name may have one, a place has none
  if (equals == std::string::npos) return std::nullopt;
  return run_socket_at(text.substr(0, equals), text.substr(equals + 1));
}

}  // namespace sim
