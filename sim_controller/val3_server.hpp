#pragma once

#include <boost/asio/io_context.hpp>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>

#include "sim_controller/served_controller.hpp"
#include "sim_controller/val3_controller.hpp"

namespace spdlog {
class logger;
}

namespace sim {

struct Val3ServerOptions {
  Val3ControllerOptions controller;
  double speed = 1.0;  // simulated seconds per wall second; kSpeedMax (controller.hpp)
  std::function<std::chrono::steady_clock::time_point()> clock = std::chrono::steady_clock::now;
  std::shared_ptr<spdlog::logger> log;  // may be null
};

/// A controller that runs a VAL3 application, with the socket that it serves on a TCP port; on the
/// io_context's one thread. One host at a time: a second connection is closed. Lives as long as this object,
/// which may go before the io_context does.
class Val3Server final : public ServedController {
 public:
  /// Listens at once; port 0 takes a free one. boost::system::system_error when the address cannot be had.
  /// The application is resolved and without errors; it outlives the server. What the machine cannot carry
  /// out is found; then there is nothing to be served.
  Val3Server(boost::asio::io_context& io, const std::string& host, std::uint16_t port, Plant plant,
             const val3::Application& application, Val3ServerOptions options, val3::Findings& findings);
  ~Val3Server() override;
  Val3Server(const Val3Server&) = delete;
  Val3Server& operator=(const Val3Server&) = delete;

  [[nodiscard]] std::uint16_t port() const override;
  void stop() override;
  void inject(const PlannedFault& fault) override;
  void change(const cell::OperatorChange& change) override;
  std::optional<std::string> jog(const cell::JogOrder& order) override;
  std::optional<std::string> bring_block(const std::string& place) override;
  [[nodiscard]] cs8::State report() const override;

 private:
  class Core;
  std::shared_ptr<Core> core_;
};

}  // namespace sim
