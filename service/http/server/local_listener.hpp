#pragma once

#include <boost/asio/any_io_executor.hpp>
#include <boost/asio/local/stream_protocol.hpp>
#include <filesystem>
#include <memory>

#include "service/http/server/body_budget.hpp"
#include "service/http/server/session.hpp"

namespace cell {

class RequestHandler;

/// Serves `handler` over a Unix socket, which only the user of the daemon can open. Its connections and
/// bodies are counted apart from those of an address, so that no crowd there shuts out this machine.
class LocalListener {
 public:
  /// Replaces a socket that a daemon left behind. Throws boost::system::system_error if the socket cannot be
  /// made, also because its path has more than 107 bytes. `handler` must outlive the listener and its
  /// connections.
  LocalListener(boost::asio::any_io_executor executor, std::filesystem::path file, RequestHandler& handler,
                HttpLimits limits = {});
  ~LocalListener() { close(); }
  LocalListener(const LocalListener&) = delete;
  LocalListener& operator=(const LocalListener&) = delete;

  void launch();
  /// Also removes the socket.
  void close();

 private:
  void serve(boost::asio::local::stream_protocol::socket socket);

  boost::asio::any_io_executor executor_;
  boost::asio::local::stream_protocol::acceptor acceptor_;
  std::filesystem::path file_;
  HttpLimits limits_;
  RequestHandler& handler_;
  std::shared_ptr<BodyBudget> bodies_;
  ConnectionTable connections_;
};

}  // namespace cell
