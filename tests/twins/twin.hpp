#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "cs8_protocol/messages.hpp"
#include "sim_controller/cabinet.hpp"
#include "sim_controller/fault_plan.hpp"
#include "sim_controller/operator.hpp"
#include "sim_controller/plant.hpp"
#include "tests/twins/scenario.hpp"

namespace twins {

/// A controller in virtual time, whichever program drives its cabinet: 4 ms a tick, one host's connection in
/// memory.
class Twin {
 public:
  Twin() = default;
  virtual ~Twin() = default;
  Twin(const Twin&) = delete;
  Twin& operator=(const Twin&) = delete;

  virtual void tick() = 0;
  /// A host's end of a connection; false while another one holds it.
  virtual bool connect() = 0;
  /// The host closes.
  virtual void disconnect() = 0;
  [[nodiscard]] virtual bool is_connected() = 0;
  virtual void give(const cs8::Message& message) = 0;
  /// What it has sent since the last call.
  virtual std::vector<cs8::Message> take() = 0;

  /// The controller's own clock, from the start. Behind a restart it may be ahead of the ticks.
  [[nodiscard]] virtual double clock_s() const = 0;
  virtual sim::Cabinet& cabinet() = 0;
  virtual sim::Operator& person() = 0;
  virtual sim::FaultPlan& plan() = 0;
};

/// The demo cell with its hidden truth, for both.
const sim::Plant& plant();
/// Simulated time at the start, seconds.
inline constexpr double kStartSeconds = 3600.0;

std::unique_ptr<Twin> make_fast_twin(const Scenario& scenario);
std::unique_ptr<Twin> make_val3_twin(const Scenario& scenario);

}  // namespace twins
