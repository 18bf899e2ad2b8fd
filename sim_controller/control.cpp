#include "sim_controller/control.hpp"

#include <boost/asio/co_spawn.hpp>
#include <boost/asio/detached.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/read_until.hpp>
#include <boost/asio/redirect_error.hpp>
#include <boost/asio/use_awaitable.hpp>
#include <boost/asio/write.hpp>
#include <set>
#include <utility>

#include "config/config_error.hpp"
#include "config/fault_file.hpp"
#include "cs8_protocol/names.hpp"
#include "sim_controller/fault_names.hpp"
#include "sim_controller/served_controller.hpp"

namespace sim {
namespace {

namespace asio = boost::asio;
using asio::ip::tcp;
using Socket = std::shared_ptr<tcp::socket>;

asio::awaitable<void> answer(tcp::socket& socket, std::string line) {
  line += '\n';
  co_await asio::async_write(socket, asio::buffer(line), asio::use_awaitable);
}

std::vector<cell::ShownValue> shown(const cs8::State& state) {
  const auto has = [&state](cs8::StateFlag flag) { return (state.flags & flag) != 0; };
  return {{"session", std::int64_t{state.session}},
          {"mode", std::string(cs8::name(state.mode))},
          {"powered", has(cs8::kPowered)},
          {"held", has(cs8::kHeld)},
          {"emergency_stop", std::int64_t{state.emergency_stop}},
          {"monitor_speed_percent", std::int64_t{state.monitor_speed_percent}},
          {"arm_calibrated", has(cs8::kArmCalibrated)},
          {"settled", has(cs8::kSettled)},
          {"probe_touched", has(cs8::kProbeTouched)},
          {"probe_loop_closed", has(cs8::kProbeLoopClosed)},
          {"touch_tested", has(cs8::kTouchTested)},
          {"cell_closed", has(cs8::kCellClosed)},
          {"retract_due", has(cs8::kRetractDue)},
          {"active_sequence", std::int64_t{state.active_sequence}},
          {"phase", std::string(cs8::name(state.phase))},
          {"permit", std::string(cs8::name(state.permit))},
          {"task_error", std::int64_t{state.task_error}},
          {"overruns", std::int64_t{state.overruns}}};
}

}  // namespace

class Control::Core : public std::enable_shared_from_this<Control::Core> {
 public:
  Core(asio::io_context& io, const std::string& host, std::uint16_t port, ControlHandler handler)
      : acceptor_(io, tcp::resolver(io).resolve(host, std::to_string(port)).begin()->endpoint()),
        handler_(std::move(handler)) {}

  void start() { asio::co_spawn(acceptor_.get_executor(), accept_all(shared_from_this()), asio::detached); }

  [[nodiscard]] std::uint16_t port() const { return port_; }

  void stop() {
    boost::system::error_code ignored;
    stopped_ = true;
    acceptor_.close(ignored);
    for (const Socket& socket : sockets_) socket->close(ignored);
  }

 private:
  static asio::awaitable<void> accept_all(std::shared_ptr<Core> self) {
    while (!self->stopped_) {
      boost::system::error_code error;
      const auto socket = std::make_shared<tcp::socket>(self->acceptor_.get_executor());
      co_await self->acceptor_.async_accept(*socket, asio::redirect_error(asio::use_awaitable, error));
      if (error || self->stopped_) continue;
      const bool is_one_too_many = self->sockets_.size() >= kControlConnectionsMax;
      if (self->sockets_.size() >= 2 * kControlConnectionsMax) continue;
      self->sockets_.insert(socket);
      asio::co_spawn(self->acceptor_.get_executor(), serve(self, socket, is_one_too_many), asio::detached);
    }
  }

  static asio::awaitable<void> serve(std::shared_ptr<Core> self, Socket socket, bool is_one_too_many) {
    try {
      if (is_one_too_many) {
        co_await answer(*socket, cell::control_refusal("too many control connections; close one"));
      } else {
        co_await self->answer_lines(*socket);
      }
    } catch (const boost::system::system_error&) {
      // The other side or stop() ended it.
    }
    boost::system::error_code ignored;
    socket->close(ignored);
    self->sockets_.erase(socket);
  }

  asio::awaitable<void> answer_lines(tcp::socket& socket) {
    std::string bytes;
    for (;;) {
      boost::system::error_code error;
      const std::size_t size =
          co_await asio::async_read_until(socket, asio::dynamic_buffer(bytes, cell::kControlLineMax + 1),
                                          '\n', asio::redirect_error(asio::use_awaitable, error));
      if (error == asio::error::not_found) {
        co_await answer(
            socket, cell::control_refusal("a line has more than " + std::to_string(cell::kControlLineMax) +
                                          " bytes; make it shorter"));
        co_return;
      }
      if (error) co_return;
      std::string answered;
      if (!stopped_) answered = handler_(std::string_view(bytes).substr(0, size - 1));
      bytes.erase(0, size);
      co_await answer(socket, std::move(answered));
    }
  }

  tcp::acceptor acceptor_;
  std::uint16_t port_ = acceptor_.local_endpoint().port();
  ControlHandler handler_;
  std::set<Socket> sockets_;
  bool stopped_ = false;
};

Control::Control(asio::io_context& io, const std::string& host, std::uint16_t port, ControlHandler handler)
    : core_(std::make_shared<Core>(io, host, port, std::move(handler))) {
  core_->start();
}

Control::~Control() { stop(); }

std::uint16_t Control::port() const { return core_->port(); }

void Control::stop() { core_->stop(); }

std::string answer_control_line(ServedController& target, std::string_view line) {
  try {
    const cell::ControlRequest request = cell::parse_control_line(line);
    if (const auto* declared = std::get_if<cell::DeclaredFault>(&request)) {
      target.inject(planned(*declared));
    } else if (const auto* change = std::get_if<cell::OperatorChange>(&request)) {
      target.change(*change);
    } else if (const auto* order = std::get_if<cell::JogOrder>(&request)) {
      if (const auto why_not = target.jog(*order)) return cell::control_refusal(*why_not);
    } else if (const auto* brought = std::get_if<cell::BlockOrder>(&request)) {
      if (const auto why_not = target.bring_block(brought->place)) return cell::control_refusal(*why_not);
    } else {
      return cell::control_answer(shown(target.report()));
    }
    return cell::control_answer();
  } catch (const cell::ConfigError& error) {
    return cell::control_refusal(error.what());
  }
}

}  // namespace sim
