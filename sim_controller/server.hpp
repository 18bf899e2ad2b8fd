#pragma once

#include <boost/asio/io_context.hpp>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "config/fault_file.hpp"
#include "sim_controller/controller.hpp"
#include "sim_controller/fault_plan.hpp"
#include "sim_controller/plant.hpp"

namespace spdlog {
class logger;
}

namespace sim {

struct ServerOptions {
  ControllerOptions controller;
  std::vector<PlannedFault> faults;
  std::function<TimePoint()> clock = std::chrono::steady_clock::now;
  std::shared_ptr<spdlog::logger> log;  // may be null
};

/// The simulated controller on a TCP port, on the io_context's one thread. Serves one host; others are told
/// kOccupied. Lives as long as this object, which may go before the io_context does.
class Server {
 public:
  /// Listens at once; port 0 takes a free one. boost::system::system_error when the address cannot be had.
  Server(boost::asio::io_context& io, const std::string& host, std::uint16_t port, Plant plant,
         ServerOptions options);
  ~Server();
  Server(const Server&) = delete;
  Server& operator=(const Server&) = delete;

  [[nodiscard]] std::uint16_t port() const;

  /// Closes every socket; nothing of the server stays in the io_context.
  void stop();

  /// Adds a fault; it counts messages and touches from now on.
  void inject(const PlannedFault& fault);
  /// Changes what the operator does by himself from now on.
  void change(const cell::OperatorChange& change);
  /// Jogs with the pendant; returns why the pendant refuses, or nothing.
  std::optional<std::string> jog(const cell::JogOrder& order);
  /// What the controller would report now.
  [[nodiscard]] cs8::State report() const;

 private:
  class Core;
  std::shared_ptr<Core> core_;
};

}  // namespace sim
