#include "service/http/server/ends.hpp"

#include <algorithm>
#include <cstdint>
#include <utility>

#include "service/http/server/session.hpp"

namespace cell {

using boost::asio::ip::tcp;

namespace {

/// Host names are compared without regard to case (ASCII).
bool same_name(std::string_view a, std::string_view b) {
  const auto lower = [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; };
  return std::ranges::equal(a, b, {}, lower, lower);
}

bool is_one_of(const std::vector<std::string>& names, std::string_view name) {
  return std::ranges::any_of(names, [&](const std::string& own) { return same_name(name, own); });
}

bool is_port_of_scheme(std::uint16_t port) { return port == 80 || port == 443; }

}  // namespace

Ends::Ends(const tcp::endpoint& client, const tcp::endpoint& own, std::string scheme,
           const HttpLimits& limits)
    : from_loopback_(limits.trusts_loopback && client.address().is_loopback()),
      remote_(client.address().to_string()),
      scheme_(std::move(scheme)) {
  const std::string port = ":" + std::to_string(own.port());
  const std::string address = own.address().to_string();
  hosts_ = {"127.0.0.1" + port, "localhost" + port, "[::1]" + port,
            (own.address().is_v6() ? "[" + address + "]" : address) + port};
  for (const HostName& given : limits.host_names) {
    given_names_.push_back(given.name + (given.port ? ":" + std::to_string(*given.port) : port));
    // At the scheme's own port, where a proxy listens, a client names none.
    if (!given.port || is_port_of_scheme(*given.port)) given_names_.push_back(given.name);
  }
  hosts_.insert(hosts_.end(), given_names_.begin(), given_names_.end());
}

Ends Ends::of_unix_socket() { return Ends(); }

bool Ends::is_our_host(std::string_view host) const { return hosts_.empty() || is_one_of(hosts_, host); }

bool Ends::is_our_origin(std::string_view origin) const {
  constexpr std::string_view kSecure = "https://";
  if (origin.starts_with(kSecure) && is_one_of(given_names_, origin.substr(kSecure.size()))) return true;
  return !hosts_.empty() && origin.starts_with(scheme_) && is_our_host(origin.substr(scheme_.size()));
}

}  // namespace cell
