#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "cs8_protocol/messages.hpp"
#include "sim_controller/cabinet.hpp"
#include "sim_controller/fault_plan.hpp"
#include "sim_controller/operator.hpp"
#include "sim_controller/placed_block.hpp"
#include "sim_controller/plant.hpp"
#include "sim_controller/val3/machine/machine.hpp"
#include "sim_controller/val3_system.hpp"

namespace sim {

struct Val3ControllerOptions {
  std::uint64_t seed = 1;  // of all that differs from one touch to the next
  OperatorDuties duties;
  std::vector<PlannedFault> faults;
  PlantByPlace plants;  // where the block can be brought to
  Val3SystemOptions system;
};

/// A controller that runs a VAL3 application in the simulated cell, with the people at it and what is to go
/// wrong; without sockets and clocks, 4 ms at a time. The other twin is the C++ one of controller.hpp.
///
/// The people look at what goes over the protocol's wire: whoever carries the bytes tells of each message.
class Val3Controller {
 public:
  /// The application is resolved and without errors, and outlives this. It is started. What the machine
  /// cannot carry out is found; then nothing runs.
  Val3Controller(Plant plant, const val3::Application& application, Val3ControllerOptions options,
                 val3::Findings& findings);

  /// What one tick brought for the link and the log.
  struct Brought {
    std::vector<LinkFault> link_faults;  // that are due
    std::vector<std::string> told;       // for the log: collisions, tasks that failed, messages
  };
  Brought tick();

  /// The socket that hosts connect to: the first one that the application has used as a server. Null before.
  [[nodiscard]] Val3Channel* host_channel();
  void note_received(const cs8::Message& message);
  void note_sent(const cs8::Message& message);

  /// Something happens or will without anybody's doing: time that passes is worth nothing. The rest of the
  /// time people and hosts decide how long it is.
  [[nodiscard]] bool is_busy() const;
  [[nodiscard]] double clock_s() const { return system_.clock_s(); }
  /// As the application reported last; before the first report, as the cabinet stands.
  [[nodiscard]] cs8::State report() const;

  /// As of ServedController.
  std::optional<std::string> bring_block(const std::string& place) {
    return sim::bring_block(plants_, place, plant_, cabinet_);
  }

  [[nodiscard]] FaultPlan& plan() { return plan_; }
  [[nodiscard]] const Plant& plant() const { return plant_; }
  [[nodiscard]] Cabinet& cabinet() { return cabinet_; }
  [[nodiscard]] const Cabinet& cabinet() const { return cabinet_; }
  [[nodiscard]] Operator& person() { return person_; }
  [[nodiscard]] Val3System& system() { return system_; }
  [[nodiscard]] val3::Machine& machine() { return *machine_; }

 private:
  void apply_due_faults(Brought& brought);
  void apply_to_application(const Trouble& trouble, Brought& brought);
  void fail_a_task(int error);
  void restart();
  void watch_tasks(Brought& brought);
  void take_messages(Brought& brought);
  void note_result(cs8::Outcome outcome);

  Plant plant_;
  PlantByPlace plants_;
  Cabinet cabinet_;
  Operator person_;
  FaultPlan plan_;
  Val3System system_;
  std::unique_ptr<val3::Machine> machine_;
  std::vector<std::string> messages_;  // of the application, since the last tick
  std::set<std::string> failed_tasks_;
  std::optional<cs8::State> state_;
  std::uint32_t touch_sequence_ = 0;  // of the last Touch that a host sent
  double busy_until_s_ = 0.0;
  std::int64_t ticks_ = 0;
  bool operator_called_ = false;  // to free the arm by hand, at the next Hello
};

}  // namespace sim
