#include "service/http/server/host_name.hpp"

#include <algorithm>
#include <charconv>

namespace cell {
namespace {

bool is_name(std::string_view name) {
  constexpr std::size_t kLengthMax = 253;
  const auto is_taken = [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '-' || c == '.';
  };
  return !name.empty() && name.size() <= kLengthMax && std::ranges::all_of(name, is_taken);
}

}  // namespace

std::optional<HostName> parse_host_name(std::string_view text) {
  const std::size_t colon = text.find(':');
  HostName host{.name = std::string(text.substr(0, colon))};
  if (!is_name(host.name)) return std::nullopt;
  if (colon == std::string_view::npos) return host;
  const std::string_view digits = text.substr(colon + 1);
  std::uint16_t port = 0;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), port);
  if (error != std::errc{} || end != digits.data() + digits.size() || port == 0) return std::nullopt;
  host.port = port;
  return host;
}

}  // namespace cell
