#pragma once

#include <boost/asio/any_io_executor.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <memory>

#include "service/http/server/body_budget.hpp"
#include "service/http/server/session.hpp"

namespace cell {

class RequestHandler;

/// Accepts connections on one address and serves `handler` over them, HTTP/1.1, with TLS where there is a
/// certificate. It is never full: ConnectionTable says which connection is closed for a new one.
class HttpListener {
 public:
  /// Binds at once; port 0 takes a free one. Throws boost::system::system_error if the address is in use.
  /// `handler` must outlive the listener and its connections.
  HttpListener(boost::asio::any_io_executor executor, const boost::asio::ip::tcp::endpoint& address,
               RequestHandler& handler, HttpLimits limits = {},
               std::shared_ptr<boost::asio::ssl::context> tls = nullptr);

  /// Accepts from now on; once more where what ran out of memory may have lost who waits for the next one.
  void launch();
  void close();
  [[nodiscard]] boost::asio::ip::tcp::endpoint address() const { return address_; }

 private:
  void serve(boost::asio::ip::tcp::socket socket);

  boost::asio::any_io_executor executor_;
  boost::asio::ip::tcp::acceptor acceptor_;
  boost::asio::ip::tcp::endpoint address_;
  HttpLimits limits_;
  std::shared_ptr<boost::asio::ssl::context> tls_;
  RequestHandler& handler_;
  std::shared_ptr<BodyBudget> bodies_;
  ConnectionTable connections_;
};

}  // namespace cell
