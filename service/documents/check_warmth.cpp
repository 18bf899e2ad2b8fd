#include "service/documents/check_warmth.hpp"

#include <spdlog/fmt/fmt.h>

#include "calib_core/kinematics/error_parameters.hpp"
#include "service/documents/verification_document.hpp"

namespace cell {

namespace {
constexpr double kPartsPerMillion = 1e-6;
}  // namespace

std::variant<CheckWarmth, std::string> warmth_of(const std::string& check_run_id, const std::string& at,
                                                 std::string_view result_json, const std::string& of_run) {
  if (schema_of(result_json) != CheckDocument().schema)
    return fmt::format("run {} is no check; touchcal runs lists the kinds", check_run_id);
  const CheckDocument check = read_check(result_json);
  if (check.of_run != of_run)
    return fmt::format(
        "check {} is of run {}, and the model that is applied of run {}: check that one, with "
        "touchcal check --of {}",
        check_run_id, check.of_run, of_run, of_run);
  if (!check.verdict.accepted || !check.growth_ppm)
    return fmt::format("check {} has no verdict: check again, three times at least for a reference",
                       check_run_id);
  if (!*check.verdict.accepted)
    return fmt::format(
        "check {} found that more than the arm's warmth has changed: mend that, or calibrate anew",
        check_run_id);
  return CheckWarmth{check_run_id, at, *check.growth_ppm * kPartsPerMillion};
}

Arm grown(const Arm& arm, const CheckWarmth& warmth) {
  Arm made = arm;
  made.model = calib::apply(arm.model, calib::errors_by_growth(arm.model, warmth.growth));
  return made;
}

}  // namespace cell
