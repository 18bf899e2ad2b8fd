#include "service/daemon/listen_address.hpp"

#include <spdlog/fmt/fmt.h>

#include <stdexcept>

#include "service/http/server/tls.hpp"

namespace cell {

using boost::asio::ip::tcp;

tcp::endpoint listen_address(boost::asio::io_context& context, const DaemonOptions& options) {
  const Endpoint& listen = options.listen;
  boost::system::error_code failure;
  tcp::resolver resolver(context);
  const auto found =
      resolver.resolve(listen.host, std::to_string(listen.port), tcp::resolver::passive, failure);
  if (failure) {
    throw std::runtime_error(
        fmt::format("--listen {}: {}; give an address of this machine", listen.host, failure.message()));
  }
  tcp::endpoint address = found.begin()->endpoint();
  if (!address.address().is_loopback() && options.tls_certificate.empty()) {
    throw std::runtime_error(
        fmt::format("--listen {}: only loopback addresses are served without TLS; give --tls-cert and "
                    "--tls-key, or use 127.0.0.1 and a proxy",
                    listen.host));
  }
  return address;
}

std::shared_ptr<boost::asio::ssl::context> tls_context(const DaemonOptions& options) {
  if (options.tls_certificate.empty() && options.tls_key.empty()) return nullptr;
  if (options.tls_certificate.empty() || options.tls_key.empty())
    throw std::runtime_error("--tls-cert and --tls-key must be given together");
  return make_tls_context(options.tls_certificate, options.tls_key);
}

}  // namespace cell
