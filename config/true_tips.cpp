#include "config/true_tips.hpp"

#include <algorithm>
#include <string>

#include "config/config_error.hpp"
#include "config/strict_json.hpp"

namespace cell {
namespace {

[[noreturn]] void refuse_tip(const Truth& truth, const std::string& name, const Probe& probe) {
  std::string known;
  for (const ProbeTip& tip : probe.tips) known += (known.empty() ? "" : ", ") + in_quotes(tip.name);
  throw ConfigError(truth.file.string(), "/tips" + pointer_step(name),
                    "the probe " + in_quotes(probe.name) + " has no such tip" +
                        (known.empty() ? R"(; leave "tips" out, or give the probe's file "tips")"
                                       : "; give one of " + known));
}

}  // namespace

std::vector<ProbeTip> true_tips(const Truth& truth, const Probe& probe) {
  std::vector<ProbeTip> tips = probe.tips;
  for (const TrueTip& off : truth.tips) {
    const auto tip = std::ranges::find(tips, off.name, &ProbeTip::name);
    if (tip == tips.end()) refuse_tip(truth, off.name, probe);
    tip->center_m += off.shift_m;
    tip->radius_m = off.radius_m.value_or(tip->radius_m);
  }
  return tips;
}

}  // namespace cell
