#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "tests/simulation/clients.hpp"
#include "tests/simulation/disk.hpp"
#include "tests/simulation/faults.hpp"
#include "tests/simulation/journal.hpp"
#include "tests/simulation/network.hpp"
#include "tests/simulation/person.hpp"
#include "tests/simulation/record.hpp"
#include "tests/simulation/script.hpp"
#include "tests/simulation/setting.hpp"
#include "tests/simulation/simulated_daemon.hpp"
#include "tests/simulation/wire.hpp"

namespace simulation {

/// Of the arm in three worlds of four, in its own time: link, disk and people do not know.
inline constexpr double kQuickSpeed = 5.0;

/// What a world is made of; its seed gives one, a test changes it.
struct Scenario {
  std::uint64_t seed = 0;
  int touch_count = kTouchesMin;
  double speed = 1.0;  // of the arm
  std::vector<DrawnFault> faults;
  /// For tests that break the program on purpose: done to the disk at that time.
  std::function<void(Disk& disk)> sabotage;
  Time sabotaged_at{};
  /// What goes wrong by what is seen. Where there is one, it starts the run, nobody frees or mends anything
  /// before the cell is at rest (Record::rest), and then the person goes by the words that he is told.
  std::vector<ScriptStep> script;
};

Scenario scenario_of(std::uint64_t seed);

struct Outcome {
  std::string journal;
  Record record;
  std::vector<std::string> broken;  // invariants, a line each
  Time virtual_time{};
};

/// Runs a world to its end. One at a time in a process.
Outcome run_world(const Scenario& scenario);

}  // namespace simulation
