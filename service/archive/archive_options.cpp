#include "service/archive/archive_options.hpp"

#include <boost/url/parse.hpp>

namespace cell {
namespace {

/// A Unix socket's directory too.
bool is_this_machine(const std::string& host) {
  return host.empty() || host == "localhost" || host == "::1" || host.starts_with("127.") ||
         host.starts_with('/');
}

}  // namespace

std::optional<std::string> archive_from_url(std::string_view url) {
  const auto parsed = boost::urls::parse_uri(url);
  if (parsed.has_error() || (parsed->scheme() != "postgresql" && parsed->scheme() != "postgres"))
    return std::nullopt;
  if (parsed->has_password() || parsed->has_fragment() || parsed->encoded_path().size() < 2)
    return std::nullopt;
  bool is_verified = false, is_here = is_this_machine(std::string(parsed->host_address()));
  for (const auto& parameter : parsed->params()) {
    if (parameter.key == "password") return std::nullopt;
    // They outrank what stands in front.
    if (parameter.key == "host" || parameter.key == "hostaddr")
      is_here = is_here && is_this_machine(std::string(parameter.value));
    if (parameter.key == "sslmode") is_verified = parameter.value == "verify-full";
  }
  if (!is_verified && !is_here) return std::nullopt;
  return std::string(url);
}

std::string with_archive_bounds(const std::string& url) {
  std::string bounded = url;
  for (const std::string_view bound :
       {"connect_timeout=5", "tcp_user_timeout=15000", "client_encoding=UTF8"}) {
    const std::string_view key = bound.substr(0, bound.find('=') + 1);
    if (bounded.find(key) != std::string::npos) continue;
    bounded += bounded.find('?') == std::string::npos ? '?' : '&';
    bounded += bound;
  }
  return bounded;
}

}  // namespace cell
