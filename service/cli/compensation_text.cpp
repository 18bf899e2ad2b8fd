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
    if (target.line_deviation_mm && *target.line_deviation_mm)
      lines += fmt::format("{:<{}}    on a straight line, at most {:.4f} mm off it\n", "", width,
                           **target.line_deviation_mm);
    if (target.reason) lines += fmt::format("{:<{}}    {}\n", "", width, *target.reason);
  }
  using calib::CompensationStatus;
  const int inserted = document.count_inserted();
  return lines +
         fmt::format(
             "\n{} targets of tool {} corrected, {} of them with a warning; {} refused and left "
             "alone\n{}model {}\n",
             document.targets.size() - static_cast<std::size_t>(document.count(CompensationStatus::kRefused)),
             tool, document.count(CompensationStatus::kWarned), document.count(CompensationStatus::kRefused),
             inserted > 0 ? fmt::format("{} of them are points inserted on straight lines\n", inserted) : "",
             document.model) +
         (document.touched ? fmt::format("its tip as touched: {}\n", document.touched->from) : "") +
         (document.warmth
              ? fmt::format("grown by {:.1f} ppm, as check {} found at {}\n", document.warmth->growth_ppm,
                            document.warmth->check_run_id, document.warmth->at)
              : "");
}

}  // namespace cell
