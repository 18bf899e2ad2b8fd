#include "service/http/auth/wrong_tokens.hpp"

#include <boost/asio/ip/address.hpp>

#include "service/http/server/connection_table.hpp"

namespace cell {

std::string network_of(const std::string& remote) {
  boost::system::error_code failure;
  const auto address = boost::asio::ip::make_address(remote, failure);
  return failure ? remote : origin_of(address).network;
}

}  // namespace cell
