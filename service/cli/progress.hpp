#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

namespace cell {

/// What a person at the pendant is to do; empty when nothing is asked of one.
std::string guidance(const nlohmann::json& status);

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
