// Each co_await stands alone in its statement and takes named values: GCC 12 miscompiles it inside conditions
// and destroys braced temporaries twice. This holds for every coroutine of this folder.
#include "service/acquisition/cs8_controller.hpp"

#include <spdlog/fmt/fmt.h>

#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/redirect_error.hpp>
#include <boost/asio/steady_timer.hpp>
#include <boost/asio/use_awaitable.hpp>
#include <memory>
#include <string>

namespace cell {

namespace asio = boost::asio;

namespace {

cs8::ClientOptions client_options(const Deadlines& deadlines) {
  return {.connect_deadline = deadlines.connect, .heartbeat_timeout = deadlines.heartbeat_timeout};
}

/// The addresses behind a name, or why there are none.
struct LookUp {
  explicit LookUp(const asio::any_io_executor& executor) : resolver(executor), waited(executor) {}
  asio::ip::tcp::resolver resolver;
  asio::steady_timer waited;
  boost::system::error_code failure = asio::error::timed_out;
  asio::ip::tcp::resolver::results_type found;
};

/// A look-up cannot be cancelled: an answer that comes too late is dropped.
asio::awaitable<std::shared_ptr<LookUp>> look_up(asio::any_io_executor executor, Endpoint endpoint,
                                                 std::chrono::milliseconds at_most) {
  auto look = std::make_shared<LookUp>(executor);
  look->waited.expires_after(at_most);
  look->resolver.async_resolve(endpoint.host, std::to_string(endpoint.port),
                               [look](const boost::system::error_code& failure, const auto& found) {
                                 look->failure = failure;
                                 look->found = found;
                                 look->waited.cancel();
                               });
  boost::system::error_code ignored;
  co_await look->waited.async_wait(asio::redirect_error(asio::use_awaitable, ignored));
  co_return look;
}

}  // namespace

Cs8Controller::Cs8Controller(asio::any_io_executor executor, const Deadlines& deadlines, Endpoint endpoint)
    : executor_(executor),
      endpoint_(std::move(endpoint)),
      look_up_max_(deadlines.connect),
      client_(executor, client_options(deadlines),
              {.on_state = [this](const cs8::State& state) { hooks_.on_state(state); },
               .on_permit = [this](const cs8::Permit& permit) { hooks_.on_permit(permit); },
               .on_heartbeat = [this] { hooks_.on_heartbeat(); },
               .on_loss = [this](const cs8::LinkError& error) { hooks_.on_loss(error); }}) {}

asio::awaitable<cs8::ConnectReply> Cs8Controller::connect(cs8::ExpectedController expected) {
  // A look-up has a thread of its own; an address needs none.
  boost::system::error_code is_a_name;
  const asio::ip::address address = asio::ip::make_address(endpoint_.host, is_a_name);
  if (!is_a_name) {
    const asio::ip::tcp::endpoint there(address, endpoint_.port);
    cs8::ConnectReply reply = co_await client_.connect(there, expected);
    co_return reply;
  }
  const auto look = co_await look_up(executor_, endpoint_, look_up_max_);
  const auto found = look->found;
  cs8::ConnectReply reply = cs8::LinkError{cs8::LinkErrorKind::kUnreachable,
                                           fmt::format("{}: {}", endpoint_.host, look->failure.message())};
  for (const auto& address : found) {
    reply = co_await client_.connect(address.endpoint(), expected);
    if (std::holds_alternative<cs8::Welcome>(reply)) break;
  }
  co_return reply;
}

}  // namespace cell
