#pragma once

#include <string>
#include <string_view>
#include <variant>

#include "config/cell.hpp"

namespace cell {

/// What a check found of the arm's warmth: a dated state beside the model of its calibration, which stays as
/// it is.
struct CheckWarmth {
  std::string check_run_id;
  std::string at;       // RFC 3339, the end of the check
  double growth = 0.0;  // of the arm's lengths since the reference, a share of them
};

/// Of the run with this result. Why not, in one sentence with the remedy: it is no check, or one of another
/// calibration than run `of_run`; it has no verdict, or says that more than the arm's warmth has changed.
std::variant<CheckWarmth, std::string> warmth_of(const std::string& check_run_id, const std::string& at,
                                                 std::string_view result_json, const std::string& of_run);

/// The arm with its lengths as the check found them.
Arm grown(const Arm& arm, const CheckWarmth& warmth);

}  // namespace cell
