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
#include "sim_controller/placed_block.hpp"
#include "sim_controller/plant.hpp"
#include "sim_controller/served_controller.hpp"

namespace spdlog {
class logger;
}

namespace sim {

struct ServerOptions {
  ControllerOptions controller;
  std::vector<PlannedFault> faults;
  PlantByPlace plants;  // where the block can be brought to
  std::function<TimePoint()> clock = std::chrono::steady_clock::now;
  std::shared_ptr<spdlog::logger> log;  // may be null
};

/// The simulated controller on a TCP port, on the io_context's one thread. Serves one host; others are told
/// kOccupied. Lives as long as this object, which may go before the io_context does.
class Server final : public ServedController {
 public:
  /// Listens at once; port 0 takes a free one. boost::system::system_error when the address cannot be had.
  Server(boost::asio::io_context& io, const std::string& host, std::uint16_t port, Plant plant,
         ServerOptions options);
  ~Server() override;
  Server(const Server&) = delete;
  Server& operator=(const Server&) = delete;

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
