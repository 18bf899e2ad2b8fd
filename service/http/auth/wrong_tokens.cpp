#include "service/http/auth/wrong_tokens.hpp"

#include <algorithm>
#include <boost/asio/ip/address.hpp>

#include "service/http/server/connection_table.hpp"

namespace cell {
namespace {

/// What is no address, as of a Unix socket, is a network of its own.
std::string name_of_network(const std::string& remote) {
  boost::system::error_code failure;
  const auto address = boost::asio::ip::make_address(remote, failure);
  return failure ? remote : origin_of(address).network;
}

}  // namespace

bool WrongTokens::is_too_often(const std::string& remote, TimePoint now) {
  Network& network = network_of(remote);
  network.latest = now;
  // Each wrong token moves this ahead; it may be ahead of the clock by what is forgiven.
  const TimePoint next = std::max(network.forgotten_at, now) + kForgetOne;
  network.forgotten_at = std::min(next, now + kForgetAllMax);
  return next - now > kAtOnce * kForgetOne;
}

WrongTokens::Network& WrongTokens::network_of(const std::string& remote) {
  std::string name = name_of_network(remote);
  const auto known = networks_.find(name);
  if (known != networks_.end()) return known->second;
  if (networks_.size() >= kNetworksMax)
    networks_.erase(
        std::ranges::min_element(networks_, {}, [](const auto& one) { return one.second.latest; }));
  return networks_[std::move(name)];
}

}  // namespace cell
