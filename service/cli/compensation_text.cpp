#include "service/cli/compensation_text.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>

#include "service/cli/figure_text.hpp"

namespace cell {
std::string compensation_text(const CompensationDocument& document, const std::string& tool) {
  std::size_t width = std::string_view("target").size();
  for (const CompensationDocument::Target& target : document.targets)
    width = std::max(width, target.name.size());
  std::string lines =
      fmt::format("{:<{}}  {:<8}{:>12}{:>12}{:>12}{:>12}{:>12}{:>12}{:>11}{:>9}\n", "target", width, "",
                  "j1 deg", "j2 deg", "j3 deg", "j4 deg", "j5 deg", "j6 deg", "moved mm", "std mm");
  for (const CompensationDocument::Target& target : document.targets) {
    lines += fmt::format("{:<{}}  {:<8}", target.name, width, word_of(target.status));
    for (std::size_t joint = 0; joint < calib::kJointCount; ++joint)
      lines +=
          fmt::format("{:>12}", target.joints_deg ? fmt::format("{:.6f}", (*target.joints_deg)[joint]) : "-");
    lines += fmt::format("{:>11}{:>9}\n", figure_or_dash(target.moved_mm, "{:.3f}"),
                         figure_or_dash(target.tip_uncertainty_mm, "{:.3f}"));
    if (target.reason) lines += fmt::format("{:<{}}    {}\n", "", width, *target.reason);
  }
  using calib::CompensationStatus;
  return lines +
         fmt::format(
             "\n{} targets of tool {} corrected, {} of them with a warning; {} refused and left "
             "alone\nmodel {}\n",
             document.targets.size() - static_cast<std::size_t>(document.count(CompensationStatus::kRefused)),
             tool, document.count(CompensationStatus::kWarned), document.count(CompensationStatus::kRefused),
             document.model) +
         (document.warmth
              ? fmt::format("grown by {:.1f} ppm, as check {} found at {}\n", document.warmth->growth_ppm,
                            document.warmth->check_run_id, document.warmth->at)
              : "");
}

}  // namespace cell
