#include "service/http/server/tls.hpp"

#include <openssl/ssl.h>

#include <stdexcept>

namespace cell {

namespace ssl = boost::asio::ssl;

std::shared_ptr<ssl::context> make_tls_context(const std::filesystem::path& certificate,
                                               const std::filesystem::path& key) {
  auto context = std::make_shared<ssl::context>(ssl::context::tls_server);
  SSL_CTX_set_min_proto_version(context->native_handle(), TLS1_2_VERSION);
  boost::system::error_code failure;
  context->use_certificate_chain_file(certificate.string(), failure);
  if (failure) {
    throw std::runtime_error(certificate.string() +
                             ": no certificate can be read from it: " + failure.message());
  }
  context->use_private_key_file(key.string(), ssl::context::pem, failure);
  if (failure) {
    throw std::runtime_error(key.string() + ": is not the certificate's key in PEM: " + failure.message());
  }
  return context;
}

}  // namespace cell
