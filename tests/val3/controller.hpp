#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "sim_controller/val3/machine/machine.hpp"
#include "tests/val3/cabinet.hpp"

namespace val3 {

/// An application that is read, resolved and run in a cabinet, 4 ms at a time. What is found in its files is
/// a failure of the test.
class Controller {
 public:
  /// `set_up` is called when the application is read and before its variables look for their links.
  Controller(const std::filesystem::path& project, Cabinet& cabinet, const std::function<void()>& set_up,
             const MachineLimits& limits = {});

  /// Tasks, then arm and world, then the clock.
  void tick();
  [[nodiscard]] const Application& application() const { return application_; }
  [[nodiscard]] Machine& machine() { return *machine_; }
  [[nodiscard]] const Machine& machine() const { return *machine_; }
  /// Names of all tasks there are, also failed ones.
  [[nodiscard]] std::vector<std::string> tasks() const;

 private:
  Application application_;
  Cabinet& cabinet_;
  std::unique_ptr<Machine> machine_;
  double began_s_ = 0;
  long ticks_ = 0;
};

}  // namespace val3
