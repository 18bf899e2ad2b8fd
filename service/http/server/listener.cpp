#include "service/http/server/listener.hpp"

#include <boost/asio/co_spawn.hpp>
#include <boost/asio/detached.hpp>
#include <utility>

#include "service/http/server/internal/accepting.hpp"

namespace cell {

namespace asio = boost::asio;
using asio::ip::tcp;

HttpListener::HttpListener(asio::any_io_executor executor, const tcp::endpoint& address,
                           RequestHandler& handler, HttpLimits limits,
                           std::shared_ptr<asio::ssl::context> tls)
    : executor_(executor),
      acceptor_(executor, address),
      address_(acceptor_.local_endpoint()),
      limits_(limits),
      tls_(std::move(tls)),
      handler_(handler),
      bodies_(std::make_shared<BodyBudget>(limits.bodies_bytes_max)),
      connections_(limits.connections) {}

void HttpListener::launch() {
  boost::system::error_code ignored;
  acceptor_.cancel(ignored);  // one that still waits from before ends
  asio::co_spawn(executor_,
                 accept_connections<tcp>(acceptor_, [this](tcp::socket socket) { serve(std::move(socket)); }),
                 asio::detached);
}

void HttpListener::close() { acceptor_.close(); }

void HttpListener::serve(tcp::socket socket) {
  boost::system::error_code gone;
  const asio::ip::address client = socket.remote_endpoint(gone).address();
  if (gone) return;  // the socket closes here
  const std::shared_ptr<Connection> connection = connections_.take(origin_of(client));
  const auto ended = [this, connection](const std::exception_ptr& thrown) {
    connections_.give_back(connection);
    log_end(thrown);
  };
  asio::co_spawn(executor_,
                 tls_ ? serve_tls_session(std::move(socket), *tls_, handler_, limits_, bodies_, connection)
                      : serve_session(std::move(socket), handler_, limits_, bodies_, connection),
                 ended);
}

}  // namespace cell
