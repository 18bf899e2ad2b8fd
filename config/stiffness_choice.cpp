#include "config/stiffness_choice.hpp"

#include <algorithm>
#include <array>
#include <utility>

namespace cell {
namespace {

constexpr std::array<std::pair<StiffnessChoice, std::string_view>, 3> kChoiceNames{
    {{StiffnessChoice::kOn, "on"}, {StiffnessChoice::kOff, "off"}, {StiffnessChoice::kAuto, "auto"}}};

}  // namespace

std::optional<StiffnessChoice> stiffness_choice_named(std::string_view name) {
  const auto* const found =
      std::ranges::find(kChoiceNames, name, [](const auto& pair) { return pair.second; });
  if (found == kChoiceNames.end()) return std::nullopt;
  return found->first;
}

bool can_estimate_stiffness(const Arm& arm) {
  return !calib::estimable_compliances(arm.nongeometric_std).empty();
}

bool is_estimated(StiffnessChoice choice, const Arm& arm) {
  return choice == StiffnessChoice::kOn || (choice == StiffnessChoice::kAuto && can_estimate_stiffness(arm));
}

}  // namespace cell
