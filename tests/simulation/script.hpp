#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "tests/simulation/faults.hpp"

namespace simulation {

/// What the watcher has to see, in its words (Watcher::on_sight), and what then happens at once.
struct ScriptStep {
  std::string sight;
  std::vector<DrawnFault> then;  // may be none: the next sight is waited for
};

/// Places what goes wrong by what is seen and not by a time. The last step is the one that is struck.
class Script {
 public:
  /// `steps` must outlive it.
  explicit Script(const std::vector<ScriptStep>& steps) : steps_(steps) {}

  void see(std::string_view sight);
  /// What is to be done now, once; null when there is nothing.
  const std::vector<DrawnFault>* take_due();
  /// All that it holds was done.
  [[nodiscard]] bool is_over() const { return at_ == steps_.size() && !is_due_; }

 private:
  const std::vector<ScriptStep>& steps_;
  std::size_t at_ = 0;   // the step that is waited for
  bool is_due_ = false;  // the step before it was seen and is not done
};

}  // namespace simulation
