#pragma once

#include <spdlog/fmt/fmt.h>

#include <cstddef>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "tests/simulation/rest.hpp"
#include "tests/simulation/watcher.hpp"
#include "tests/simulation/world.hpp"

namespace simulation {

/// The process of the daemon, as the machine sees it.
struct Process {
  std::unique_ptr<SimulatedDaemon> daemon;
  Time starts_at{0};
  Time due{0};                    // it has nothing to do before
  std::optional<Time> killed_by;  // it was told to end
  std::optional<int> writes_left;
  bool dies_now = false;
  bool power_fails = false;
  Time store_answers_at{0};
};

/// What a command was refused with, as the person hears it.
inline std::string refusal_text(const cell::CommandRefusal& refusal) {
  if (refusal.code) return fmt::format("refused {}", cell::describe(*refusal.code).name);
  return refusal.unmet.empty() ? "refused" : fmt::format("refused {}", refusal.unmet.front().code);
}

/// A world while it runs (world.cpp); what goes wrong in it: world_faults.cpp.
class World {
 public:
  explicit World(const Scenario& scenario);
  ~World();
  World(const World&) = delete;
  World& operator=(const World&) = delete;

  Outcome run();

 private:
  void go_on_to_end();
  void begin_daemon();
  void end_daemon(const std::string& how);
  [[nodiscard]] std::string death_text() const;
  void kill_if_due();
  void let_happen();
  void begin(const DrawnFault& fault);
  void begin_for_a_time(const DrawnFault& fault, const std::function<void()>& end);
  void disk_trouble(const DrawnFault& fault, DiskTrouble trouble);
  void poke() { process_.due = cell_due_ = clock_.now(); }
  void strike_due();
  void look_for_rest();
  void mend();
  void take_turn_of_daemon();
  void take_turns();
  [[nodiscard]] Time next_event() const;
  void start_run();
  void note_store(const std::string& occasion, bool with_results);

  const Scenario& scenario_;
  VirtualClock clock_;
  Journal journal_{clock_};
  Record record_;
  Watcher watcher_{clock_, journal_, record_};
  Network network_{clock_, scenario_.seed + 1};
  Disk disk_{clock_, scenario_.seed + 2};
  Context cell_context_;
  sim::Server controller_;
  Person person_;
  Clients clients_{clock_, network_, journal_, record_, scenario_.seed + 4};
  Process process_;
  std::shared_ptr<const cell::Plan> plan_;
  std::multimap<Time, std::function<void()>> events_;
  Script script_{scenario_.script};
  RestWatch rest_{record_.rest};
  Time next_look_for_rest_{0};
  std::vector<std::function<void()>> mended_;  // ends of what lasts until then
  std::ptrdiff_t given_before_rest_ = 0;       // commands, by the script's start
  Time cell_due_{0};
};

}  // namespace simulation
