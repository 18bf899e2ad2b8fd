#include "config/stiffness_choice.hpp"

#include <algorithm>
#include <array>
#include <utility>

#include "config/config_error.hpp"

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

std::string_view name_of(StiffnessChoice choice) {
  return std::ranges::find(kChoiceNames, choice, [](const auto& pair) { return pair.first; })->second;
}

bool can_estimate_stiffness(const Arm& arm) {
  return !calib::estimable_compliances(arm.nongeometric_std).empty();
}

bool is_estimated(StiffnessChoice choice, const Arm& arm) {
  return choice == StiffnessChoice::kOn || (choice == StiffnessChoice::kAuto && can_estimate_stiffness(arm));
}

Recipe with_stiffness(Recipe recipe, StiffnessChoice choice, const Cell& cell) {
  if (choice == StiffnessChoice::kOn && !can_estimate_stiffness(cell.arm)) {
    throw ConfigError(
        cell.file.string(), "/arm",
        "the arm " + in_quotes(cell.arm.name) +
            " has no masses or no std_compliance_rad_per_nm; add \"gravity\" to its file or leave the "
            "stiffness \"off\"");
  }
  recipe.identification.stiffness = is_estimated(choice, cell.arm);
  return recipe;
}

}  // namespace cell
