#pragma once

#include <stdexcept>
#include <string>
#include <variant>

#include "calib_core/planning/touch_planning.hpp"
#include "config/read_config.hpp"
#include "config/truth.hpp"
#include "sim_controller/plant.hpp"

/// The cells and the recipe that the figures of the README hold for.
namespace touchcal::testing {

inline constexpr const char* kRecipe = "edf-25";
inline constexpr int kFitPerPlane = 25;
inline constexpr int kHeldOutPerPlane = 10;
inline constexpr int kPlaneCount = 4;
inline constexpr int kTouchCount = kPlaneCount * (kFitPerPlane + kHeldOutPerPlane);

/// What the touches of edf-25 have to show of an arm whose tip lies on joint 6's axis.
inline constexpr int kRank = 25;
inline constexpr int kIterationsMax = 5;
inline constexpr double kConditionNumberMax = 300.0;

/// What held-out touches have to show; the rms in parts of the declared noise, over all of them.
inline constexpr double kHeldOutMeanMaxMetres = 0.03e-3;
inline constexpr double kHeldOutRmsMaxPart = 1.5;
inline constexpr double kHeldOutRmsMedianMaxPart = 1.2;
inline constexpr double kRmsRemovedMin = 0.99;

inline std::string cell_folder(const std::string& name) {
  return std::string(TOUCHCAL_SOURCE_DIR) + "/config/cells/" + name;
}
inline std::string cell_file(const std::string& name) { return cell_folder(name) + "/cell.json"; }

inline cell::Cell shipped_cell(const std::string& name) { return cell::read_cell(cell_file(name)); }

inline calib::ErrorVector shipped_truth(const std::string& name) {
  return cell::read_truth(cell_folder(name) + "/truth.json").errors;
}

}  // namespace touchcal::testing
