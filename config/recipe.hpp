#pragma once

#include <array>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "calib_core/planning/touch_planning.hpp"

namespace cell {

/// What a criterion is called in files and documents.
inline constexpr std::array<std::pair<calib::PlanCriterion, std::string_view>, 4> kCriterionNames{
    {{calib::PlanCriterion::kTipInBox, "tip_box"},
     {calib::PlanCriterion::kTipInJointRanges, "tip_joint_ranges"},
     {calib::PlanCriterion::kInformation, "information"},
     {calib::PlanCriterion::kConditionNumber, "condition_number"}}};

/// Which touches a run makes and how they are identified.
struct Recipe {
  std::string name;
  std::string description;
  std::vector<int> faces;  // indices into the block's faces
  /// Where the block stands after the first place, in this order; indices into the block's places.
  std::vector<int> places;
  /// What touches at each place beside the first tip, in this order; indices into the probe's tips.
  std::vector<int> tips;
  int fit_per_face = 0;  // exactly so many on each of them; 0: goal.fit_count in all, spread as is best
  int held_out_per_face = 0;
  calib::PlanGoal goal;
  /// After so many touches the reference place is touched again, at the start and at the end too; 0: never.
  int reference_every = 10;
  int candidate_count = 20'000;  // touches to choose from; not in the file
  calib::IdentificationOptions identification;
};

}  // namespace cell
