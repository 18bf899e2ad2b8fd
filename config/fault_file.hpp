#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include "calib_core/geometry/joint_vector.hpp"

namespace cell {

inline constexpr std::string_view kFaultsSchema = "touchcal/faults/1";
/// Faults in one file.
inline constexpr std::size_t kDeclaredFaultsMax = 1000;
/// No delay, duration or wait is longer.
inline constexpr double kFaultTimeMaxSeconds = 3600.0;
/// Of one line of the control connection, without its line break.
inline constexpr std::size_t kControlLineMax = 4096;

/// The n-th time, from 1, or every time.
struct Occurrence {
  int nth = 1;
  bool every = false;
};

/// A fault as it was written. Which names there are, and which of them takes which figure, only the simulator
/// knows.
struct DeclaredFault {
  std::string fault;
  std::optional<std::string> on;  // a message's name
  std::optional<Occurrence> count;
  std::optional<Occurrence> touch;
  std::optional<std::string> phase;
  std::optional<double> after_s;
  // Figures, each for some faults:
  std::optional<double> duration_s;
  std::optional<int> error;
  std::optional<int> percent;
  std::optional<int> times;

  std::string source;   // what the document is called
  std::string pointer;  // of the fault in the file

  /// Throws ConfigError at this key of the fault, or at the fault itself for "".
  [[noreturn]] void fail(std::string_view key, const std::string& message) const;
};

/// What the simulated operator does unasked.
struct OperatorDuties {
  bool powers_up = true;      // at the start
  bool touches_probe = true;  // when the application asks for the touch test
  bool confirms = true;       // when the application waits for it
  bool frees_arm = true;      // after a collision or an unexpected contact, when a host says Hello
};

/// What is not there stays as it is.
struct OperatorChange {
  std::optional<bool> powers_up;
  std::optional<bool> touches_probe;
  std::optional<bool> confirms;
  std::optional<bool> frees_arm;
};

OperatorDuties changed(OperatorDuties duties, const OperatorChange& change);

struct FaultFile {
  OperatorDuties duties;
  std::vector<DeclaredFault> faults;
};

/// ConfigError with the place, also for figures that make no sense.
FaultFile read_faults(const std::filesystem::path& file);

// ---- the control connection of the simulator: lines of JSON ----

struct ShowState {};

/// A person moves the arm with the pendant: to joints, or the tool centre along a line in R_-1.
struct JogOrder {
  std::optional<calib::JointVector> joints;  // one of these two
  std::optional<Eigen::Vector3d> move_m;
  double speed_m_s = 0.01;
  bool until_touch = true;  // he stops when the probe trips
};

/// A person brings the block to another of its places. Which there are, only the simulator knows.
struct BlockOrder {
  std::string place;
};

using ControlRequest = std::variant<DeclaredFault, OperatorChange, ShowState, JogOrder, BlockOrder>;

/// One line: a fault, {"operator":{...}}, {"show":"state"}, {"block":"PLACE"} or {"jog":{...}} with
/// joints_deg or move_mm, and speed_mm_s (10, at most 250) and until_touch (true). ConfigError, whatever the
/// bytes are.
ControlRequest parse_control_line(std::string_view line);

using ShownValue = std::pair<std::string, std::variant<bool, std::int64_t, std::string>>;

/// {"ok":true}, with {"state":{...}} when there is something to show.
std::string control_answer(const std::vector<ShownValue>& state = {});
/// {"ok":false,"error":"..."}; bytes that are no UTF-8 are replaced.
std::string control_refusal(const std::string& error);

}  // namespace cell
