#pragma once

#include <gtest/gtest.h>

#include <string>

#include "tests/val3/controller.hpp"
#include "tests/val3/small_project.hpp"

namespace val3 {

/// A small project that runs in a cabinet of its own, with an input that has a latch, outputs and a socket.
class Running {
 public:
  explicit Running(SmallProject& project, MachineLimits limits = {})
      : controller(
            project.write().path(), cabinet, [this] { set_up(); }, limits) {
    machine().start();
  }
  [[nodiscard]] Machine& machine() { return controller.machine(); }
  void ticks(int count) {
    for (int i = 0; i < count; ++i) controller.tick();
  }
  double number(const std::string& variable, std::size_t index = 0) {
    return machine().number(variable, index);
  }
  std::string text(const std::string& variable, std::size_t index = 0) {
    return machine().text(variable, index);
  }
  bool truth(const std::string& variable) { return machine().truth(variable); }
  std::string log() {
    std::string all;
    for (const std::string& line : cabinet.lines) all += line + "\n";
    return all;
  }

  Cabinet cabinet;
  Controller controller;

 private:
  void set_up() {
    cabinet.inputs["FastIO\\fIn0"] = false;
    cabinet.inputs["BasicIO-1\\%I0"] = false;
    cabinet.latch_inputs.insert("FastIO\\fIn0");
    cabinet.outputs["BasicIO-1\\%Q0"] = false;
    cabinet.analogues["BasicIO-1\\%QW0"] = 0.0;
  }
};

}  // namespace val3
