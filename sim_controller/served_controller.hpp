#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "config/fault_file.hpp"
#include "cs8_protocol/messages.hpp"
#include "sim_controller/fault_plan.hpp"

namespace sim {

/// A simulated controller on a port; people and tests act on it while it runs.
class ServedController {
 public:
  ServedController() = default;
  virtual ~ServedController() = default;
  ServedController(const ServedController&) = delete;
  ServedController& operator=(const ServedController&) = delete;

  [[nodiscard]] virtual std::uint16_t port() const = 0;
  /// Closes every socket; nothing of it stays in the io_context.
  virtual void stop() = 0;

  /// Adds a fault; it counts messages and touches from now on.
  virtual void inject(const PlannedFault& fault) = 0;
  /// Changes what the operator does by himself from now on.
  virtual void change(const cell::OperatorChange& change) = 0;
  /// Jogs with the pendant; returns why the pendant refuses, or nothing.
  virtual std::optional<std::string> jog(const cell::JogOrder& order) = 0;
  /// A person brings the block to another of its places; returns why that is impossible, or nothing.
  virtual std::optional<std::string> bring_block(const std::string& place) = 0;
  /// What the controller would report now.
  [[nodiscard]] virtual cs8::State report() const = 0;
};

}  // namespace sim
