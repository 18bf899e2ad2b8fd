#pragma once

#include <boost/asio/any_io_executor.hpp>
#include <boost/asio/awaitable.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <map>
#include <memory>

#include "service/http/api.hpp"
#include "service/http/session.hpp"
#include "service/http/tokens.hpp"

namespace cell {

class CellOperation;

/// Accepts connections on one address and serves the API over them, HTTP/1.1, with TLS where there is a
/// certificate.
class HttpListener {
 public:
  /// Binds at once; port 0 takes a free one. Throws boost::system::system_error when the address is taken.
  HttpListener(boost::asio::any_io_executor executor, const boost::asio::ip::tcp::endpoint& address,
               CellOperation& operation, Tokens tokens, HttpLimits limits = {},
               std::shared_ptr<boost::asio::ssl::context> tls = nullptr);

  void launch();
  void close();
  [[nodiscard]] boost::asio::ip::tcp::endpoint address() const { return address_; }
  [[nodiscard]] Api& api() { return api_; }

 private:
  boost::asio::awaitable<void> accept();
  [[nodiscard]] bool has_room(const boost::asio::ip::address& client) const;
  void serve(boost::asio::ip::tcp::socket socket);

  boost::asio::any_io_executor executor_;
  boost::asio::ip::tcp::acceptor acceptor_;
  boost::asio::ip::tcp::endpoint address_;
  HttpLimits limits_;
  std::shared_ptr<boost::asio::ssl::context> tls_;
  Api api_;
  int connections_ = 0;
  std::map<boost::asio::ip::address, int> connections_of_;
};

}  // namespace cell
