#include "service/http/server/local_listener.hpp"

#include <sys/stat.h>

#include <boost/asio/co_spawn.hpp>
#include <boost/asio/detached.hpp>
#include <utility>

#include "service/http/server/internal/accepting.hpp"
#include "service/http/server/request_handler.hpp"

namespace cell {

namespace asio = boost::asio;
using local = asio::local::stream_protocol;

namespace {

/// Every client of the socket has the same origin, whose quota is that of a loopback address.
const ConnectionOrigin kThisMachine{.is_loopback = true, .network = "unix"};

/// Bound for the owner only: from the first moment, hence the mask.
void bind_for_owner(local::acceptor& acceptor, const std::filesystem::path& file) {
  const local::endpoint address(file.string());
  std::error_code ignored;
  if (std::filesystem::is_socket(file, ignored)) std::filesystem::remove(file, ignored);
  acceptor.open(address.protocol());
  constexpr mode_t kOthersMask = 0177;
  const mode_t before = ::umask(kOthersMask);
  boost::system::error_code failure;
  acceptor.bind(address, failure);
  ::umask(before);
  if (failure) throw boost::system::system_error(failure);
  acceptor.listen();
}

}  // namespace

LocalListener::LocalListener(asio::any_io_executor executor, std::filesystem::path file,
                             RequestHandler& handler, HttpLimits limits)
    : executor_(executor),
      acceptor_(executor),
      file_(std::move(file)),
      limits_(std::move(limits)),
      handler_(handler),
      bodies_(std::make_shared<BodyBudget>(limits_.bodies_bytes_max)),
      connections_(limits_.connections) {
  bind_for_owner(acceptor_, file_);
}

void LocalListener::launch() {
  boost::system::error_code ignored;
  acceptor_.cancel(ignored);  // as in HttpListener
  asio::co_spawn(
      executor_,
      accept_connections<local>(acceptor_, [this](local::socket socket) { serve(std::move(socket)); }),
      asio::detached);
}

void LocalListener::close() {
  if (!acceptor_.is_open()) return;
  boost::system::error_code ignored;
  acceptor_.close(ignored);
  std::error_code removed;
  std::filesystem::remove(file_, removed);
}

void LocalListener::serve(local::socket socket) {
  const std::shared_ptr<Connection> connection = connections_.take(kThisMachine);
  asio::co_spawn(executor_, serve_local_session(std::move(socket), handler_, limits_, bodies_, connection),
                 [this, connection](const std::exception_ptr& thrown) {
                   connections_.give_back(connection);
                   log_end(thrown);
                 });
}

}  // namespace cell
