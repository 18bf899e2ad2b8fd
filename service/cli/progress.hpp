#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

namespace cell {

/// The instruction to the person at the pendant, if any.
std::string guidance(const nlohmann::json& status);

/// Shows the progress of a run from successive status documents: a bar that is redrawn on a terminal, a line
/// at each relevant change elsewhere.
class Progress {
 public:
  explicit Progress(bool on_terminal) : on_terminal_(on_terminal) {}

  void show(const nlohmann::json& status);
  /// Ends the line under way.
  void finish();

 private:
  void show_fault(const nlohmann::json& status);
  void show_guidance(const nlohmann::json& status);

  bool on_terminal_;
  bool line_open_ = false;
  std::string last_state_;
  std::string last_fault_;
  std::string last_awaited_;
  std::string last_guidance_;
  int last_tenth_ = -1;
};

}  // namespace cell
