#include "service/acquisition/outlier_retest.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <utility>

#include "calib_core/geometry/units.hpp"
#include "service/run/run.hpp"

namespace cell {

std::vector<int> suspects_of(const calib::IdentificationResult& result, const calib::OnlineArmEstimate& aim) {
  std::vector<calib::RejectedTouch> rejected = result.rejected;
  std::ranges::stable_sort(rejected, std::ranges::greater(),
                           [](const calib::RejectedTouch& touch) { return std::abs(touch.residual_m); });
  std::vector<int> numbers;
  const auto add = [&numbers](std::size_t index) {
    const int number = static_cast<int>(index) + 1;
    if (std::ranges::find(numbers, number) == numbers.end()) numbers.push_back(number);
  };
  for (const calib::RejectedTouch& touch : rejected) add(touch.touch);
  for (const std::size_t index : aim.contradicted()) add(index);
  return numbers;
}

void OutlierRetest::begin_run() {
  suspect_.reset();
  made_again_.clear();
}

void OutlierRetest::begin(Suspect suspect) {
  made_again_.insert(suspect.number);
  suspect_ = std::move(suspect);
}

OutlierRetest::Finding OutlierRetest::judge(const StoredTouch& first, const StoredTouch& again,
                                            double apart_m, double agreement_m) const {
  const std::string detail = fmt::format("touch {}, {:.3f} mm apart from its repetition", first.number,
                                         calib::mm_from_metres(apart_m));
  const Confirmed stays{{FaultCode::kTouchOutlier, detail}};
  if (apart_m <= agreement_m) return stays;
  calib::OnlineArmEstimate aim = suspect_->without;
  if (suspect_->at_end) {
    if (aim.replace(static_cast<std::size_t>(first.number - 1), to_touch(again)))
      return Replaced{again, std::move(aim)};
    return stays;
  }
  if (aim.add(to_touch(again)).contradicts) return Held{{FaultCode::kTouchDoesNotFit, detail}};
  return Replaced{again, std::move(aim)};
}

bool OutlierRetest::is_pair(const StoredTouch& first, const StoredTouch& again, double apart_m,
                            double agreement_m) {
  return apart_m <= agreement_m && first.source == cs8::CaptureSource::kLatched &&
         again.source == cs8::CaptureSource::kLatched;
}

Fault OutlierRetest::warning_of(const std::vector<int>& suspects) const {
  std::string numbers;
  for (const int number : suspects)
    numbers += fmt::format("{}touch {}{}", numbers.empty() ? "" : ", ", number,
                           was_made_again(number) ? "" : " (not made again)");
  return {FaultCode::kTouchOutlier, numbers};
}

}  // namespace cell
