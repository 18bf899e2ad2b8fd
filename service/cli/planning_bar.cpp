#include "service/cli/planning_bar.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <cstdio>

namespace cell {
namespace {

constexpr int kPlanningBarWidth = 30;

}  // namespace

void PlanningBar::show(std::string_view stage, double share) {
  const int percent = static_cast<int>(100.0 * std::clamp(share, 0.0, 1.0));
  if (!on_terminal_ || percent == shown_percent_) return;
  shown_percent_ = percent;
  const auto filled = static_cast<std::size_t>(percent * kPlanningBarWidth / 100);
  fmt::print(stderr, "\r\033[K[{}{}] {:>3} %  {}", std::string(filled, '#'),
             std::string(kPlanningBarWidth - filled, '.'), percent, stage);
  std::fflush(stderr);
}

void PlanningBar::finish() {
  if (shown_percent_ >= 0) fmt::print(stderr, "\r\033[K");
  shown_percent_ = -1;
}

}  // namespace cell
