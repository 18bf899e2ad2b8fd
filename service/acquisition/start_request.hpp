#pragma once

#include <optional>
#include <string>

#include "config/cell.hpp"
#include "config/stiffness_choice.hpp"
#include "service/acquisition/plan_cache.hpp"
#include "service/run/run_conditions.hpp"

namespace cell {

/// A request for a run.
struct StartRequest {
  RunKind kind = RunKind::kCalibration;
  std::optional<std::int64_t> of_run;  // the calibration to prove or check; nothing: see find_calibration()
  std::string recipe;                  // of a proof or a check: that of the calibration
  std::string tool;                    // of RunKind::kTool
  std::optional<std::string> idempotency_key;
  std::optional<std::string> operator_name;
  std::optional<BlockTemperature> block_temperature;  // of this run, in place of that of the block's file
  std::optional<double> arm_moving_min;               // how long the arm has moved before, as a person says
  std::optional<StiffnessChoice> stiffness;           // of this run, in place of the recipe's
  bool guided = false;  // a person makes the touches with the pendant; nothing is commanded
  std::shared_ptr<const Verification> verification;  // set by the start unless it calibrates
  std::optional<QualifiedNoise> qualified;           // set by the start where it calibrates
};

/// What the plan of a run that is started so is made with.
PlanGiven given_to(const StartRequest& request, const Cell& cell);

/// The recipe of the request with its choice of stiffness; of a proof or a check, with its touches. The cell
/// must have a recipe of that name. ConfigError when the choice is kOn and the cell's arm does not allow it.
Recipe recipe_of(const StartRequest& request, const Cell& cell);

/// The choice of stiffness as a run keeps it; nothing: the recipe's.
std::optional<std::string> stiffness_to_store(const StartRequest& request);

}  // namespace cell
