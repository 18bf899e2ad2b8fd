#include "tests/end_to_end/relay.hpp"

#include <boost/asio/co_spawn.hpp>
#include <boost/asio/detached.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/use_awaitable.hpp>
#include <utility>

#include "cs8_protocol/framing.hpp"

namespace touchcal::testing {

namespace asio = boost::asio;
using asio::ip::tcp;

namespace {

struct Cable {
  tcp::socket daemon;
  tcp::socket controller;

  void cut() {
    boost::system::error_code ignored;
    daemon.close(ignored);
    controller.close(ignored);
  }
};

}  // namespace

class Relay::Core : public std::enable_shared_from_this<Relay::Core> {
 public:
  Core(asio::io_context& io, std::uint16_t controller_port, std::function<void(const cs8::Message&)> watch)
      : acceptor_(io, {asio::ip::address_v4::loopback(), 0}),
        controller_(asio::ip::address_v4::loopback(), controller_port),
        watch_(std::move(watch)) {}

  void start() { asio::co_spawn(acceptor_.get_executor(), accept(shared_from_this()), asio::detached); }

  void stop() {
    boost::system::error_code ignored;
    acceptor_.close(ignored);
    watch_ = nullptr;
    pull();
  }

  void pull() {
    if (cable_) cable_->cut();
  }

  [[nodiscard]] std::uint16_t port() const { return acceptor_.local_endpoint().port(); }

 private:
  // Each coroutine holds the core; a socket that is closed or whose other end goes away ends it by
  // system_error.

  static asio::awaitable<void> accept(std::shared_ptr<Core> self) {
    for (;;) {
      tcp::socket daemon = co_await self->acceptor_.async_accept(asio::use_awaitable);
      auto cable =
          std::make_shared<Cable>(Cable{std::move(daemon), tcp::socket(self->acceptor_.get_executor())});
      co_await cable->controller.async_connect(self->controller_, asio::use_awaitable);
      cable->daemon.set_option(tcp::no_delay(true));
      cable->controller.set_option(tcp::no_delay(true));
      self->cable_ = cable;
      asio::co_spawn(self->acceptor_.get_executor(), pass(self, cable, true), asio::detached);
      asio::co_spawn(self->acceptor_.get_executor(), pass(self, cable, false), asio::detached);
    }
  }

  static asio::awaitable<void> pass(std::shared_ptr<Core> self, std::shared_ptr<Cable> cable,
                                    bool to_daemon) {
    tcp::socket& from = to_daemon ? cable->controller : cable->daemon;
    tcp::socket& to = to_daemon ? cable->daemon : cable->controller;
    try {
      for (;;) {
        const cs8::DecodeResult frame = co_await cs8::read_frame(from);
        const cs8::Message message = std::get<cs8::Message>(frame);
        if (self->watch_) self->watch_(message);
        co_await cs8::write_frame(to, message);
      }
    } catch (const boost::system::system_error&) {
      cable->cut();
    }
  }

  tcp::acceptor acceptor_;
  tcp::endpoint controller_;
  std::function<void(const cs8::Message&)> watch_;
  std::shared_ptr<Cable> cable_;
};

Relay::Relay(asio::io_context& io, std::uint16_t controller_port,
             std::function<void(const cs8::Message&)> watch)
    : core_(std::make_shared<Core>(io, controller_port, std::move(watch))) {
  core_->start();
}

Relay::~Relay() { core_->stop(); }

std::uint16_t Relay::port() const { return core_->port(); }

void Relay::pull() { core_->pull(); }

}  // namespace touchcal::testing
