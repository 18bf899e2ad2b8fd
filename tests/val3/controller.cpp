#include "tests/val3/controller.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "sim_controller/val3/files/read_application.hpp"
#include "sim_controller/val3/language/resolver.hpp"

namespace val3 {

Controller::Controller(const std::filesystem::path& project, Cabinet& cabinet,
                       const std::function<void()>& set_up, const MachineLimits& limits)
    : cabinet_(cabinet) {
  ReadApplication read = read_application(project);
  application_ = std::move(read.application);
  resolve(application_, read.findings);
  set_up();
  began_s_ = cabinet.now_s;
  machine_ = std::make_unique<Machine>(application_, cabinet, read.findings, limits);
  for (const Finding& finding : read.findings)
    if (finding.severity == Severity::kError)
      ADD_FAILURE() << finding.at.file << ':' << finding.at.line << ": " << finding.what;
}

void Controller::tick() {
  machine_->tick();
  for (int i = 0; i < static_cast<int>(std::round(kTickSeconds / kStepSeconds)); ++i) cabinet_.step();
  cabinet_.now_s = began_s_ + static_cast<double>(++ticks_) * kTickSeconds;
}

std::vector<std::string> Controller::tasks() const {
  std::vector<std::string> names;
  for (const TaskView& task : machine_->tasks()) names.push_back(task.name);
  return names;
}

}  // namespace val3
