#pragma once

#include <map>
#include <string>

namespace architecture {

/// Units (a .cpp without its ending) that have no test of the same name in the same place below tests/, and
/// why.
inline const std::map<std::string, std::string> kUnitsWithoutTest{
    {"calib_core/estimation/gauss_newton", "steps in identification/identify_test: histories and refusals"},
    {"calib_core/estimation/goodness_of_fit",
     "levels in tests/figures, figures in identification/identify_test"},
    {"calib_core/estimation/outlier_rejection",
     "needs a whole identification: tests/figures/block_study_test"},
    {"calib_core/identification/face_distances", "reference figures in identification/identify_test"},
    {"calib_core/kinematics/error_parameters",
     "against differences of poses: kinematics/kinematic_model_test"},
    {"calib_core/planning/aimed_touch", "needs an estimate with touches: planning/online_estimate_test"},
    {"calib_core/planning/aimed_transfer", "needs an estimate with touches: planning/online_estimate_test"},
    {"calib_core/planning/internal/condition_number_exchange", "planning/internal/fedorov_exchange_test"},
    {"calib_core/planning/internal/touch_order",
     "order and times of a whole plan: planning/touch_planning_test"},
    {"calib_core/planning/planning_problem", "the slow zone of a whole plan: planning/touch_planning_test"},
    {"calib_core/planning/transfer_planning", "between all touches of a plan: planning/touch_planning_test"},
    {"calib_core/uncertainty/scale_check", "rates of warnings in tests/figures/scale_test"},
    {"calib_core/uncertainty/uncertainty_propagation",
     "coverage of simulated errors in tests/figures/intervals_test"},
};

}  // namespace architecture
