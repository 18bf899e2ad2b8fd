#include "service/archive/archive_options.hpp"

#include <boost/url/parse.hpp>
#include <cstdlib>

namespace cell {
namespace {

/// A Unix socket's directory too. Not a list of hosts, and no name that only begins as an address.
bool is_this_machine(const std::string& host) {
  if (host.starts_with('/')) return host.find(',') == std::string::npos;
  return host == "localhost" || host == "::1" ||
         (host.starts_with("127.") && host.find_first_not_of("0123456789.") == std::string::npos);
}

/// libpq takes the host from there where the address says none, and the numeric address in any case.
bool environment_names_another(bool says_host) {
  const auto is_set = [](const char* name) {
    const char* value = std::getenv(name);
    return value != nullptr && *value != '\0';
  };
  if (is_set("PGSERVICE") || (is_set("PGHOSTADDR") && !is_this_machine(std::getenv("PGHOSTADDR"))))
    return true;
  return !says_host && is_set("PGHOST") && !is_this_machine(std::getenv("PGHOST"));
}

}  // namespace

std::optional<std::string> archive_from_url(std::string_view url) {
  const auto parsed = boost::urls::parse_uri(url);
  if (parsed.has_error() || (parsed->scheme() != "postgresql" && parsed->scheme() != "postgres"))
    return std::nullopt;
  // The parser takes 127.0.0.1.example.org for an address with a path behind it.
  if (!parsed->encoded_path().starts_with('/')) return std::nullopt;
  if (parsed->has_password() || parsed->has_fragment() || parsed->encoded_path().size() < 2)
    return std::nullopt;
  const std::string named(parsed->host_address());
  bool is_verified = false, says_host = !named.empty(), is_here = named.empty() || is_this_machine(named);
  for (const auto& parameter : parsed->params()) {
    if (parameter.key == "password") return std::nullopt;
    // They outrank what stands in front.
    if (parameter.key == "host" || parameter.key == "hostaddr") {
      says_host = true;
      is_here = is_here && is_this_machine(std::string(parameter.value));
    }
    if (parameter.key == "service") is_here = false;
    if (parameter.key == "sslmode") is_verified = parameter.value == "verify-full";
    if (parameter.key == "ssl") is_verified = false;  // another word for sslmode=require
  }
  if (!is_verified && (!is_here || environment_names_another(says_host))) return std::nullopt;
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
