#pragma once

#include <gtest/gtest.h>

#include "tests/val3/application.hpp"
#include "tests/val3/interpreter.hpp"
#include "tests/val3/small_project.hpp"

namespace val3 {

/// A small project that runs in a cabinet of its own.
class Running {
 public:
  explicit Running(SmallProject& project, Limits limits = {})
      : loaded_(load(project.write().path())), interpreter(loaded_.application, cabinet, limits) {
    for (const Problem& problem : loaded_.problems) ADD_FAILURE() << problem.message();
    cabinet.inputs["FastIO\\fIn0"] = false;
    cabinet.latch_inputs.insert("FastIO\\fIn0");
    cabinet.outputs["BasicIO-1\\%Q0"] = false;
    cabinet.sockets["Socket\\host"];
    if (loaded_.problems.empty()) interpreter.start();
  }
  void ticks(int count) {
    for (int i = 0; i < count; ++i) interpreter.tick();
  }
  template <class T>
  T get(const std::string& variable, double index = 0) {
    return std::get<T>(loaded_.application.globals.at(variable).place.element(index).read());
  }
  double number(const std::string& variable, double index = 0) { return get<double>(variable, index); }
  std::string log() {
    std::string all;
    for (const std::string& line : cabinet.log) all += line + "\n";
    return all;
  }

  Cabinet cabinet;

 private:
  Loaded loaded_;

 public:
  Interpreter interpreter;
};

}  // namespace val3
