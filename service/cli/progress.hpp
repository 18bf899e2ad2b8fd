#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

namespace cell {

/// Shows how a run goes, from one status document after the other: a bar that is drawn anew on a terminal, a
/// plain line at each change worth one elsewhere.
class Progress {
 public:
  explicit Progress(bool on_terminal) : on_terminal_(on_terminal) {}

  void show(const nlohmann::json& status);
  /// Ends the line that is being drawn.
  void finish();

 private:
  void show_fault(const nlohmann::json& status);

  bool on_terminal_;
  bool line_open_ = false;
  std::string last_state_;
  std::string last_fault_;
  std::string last_awaited_;
  int last_tenth_ = -1;
};

}  // namespace cell
