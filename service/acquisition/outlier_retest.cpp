#include "service/acquisition/outlier_retest.hpp"

#include <spdlog/fmt/fmt.h>

#include "calib_core/geometry/units.hpp"
#include "service/run/run.hpp"

namespace cell {

OutlierRetest::Finding OutlierRetest::judge(const StoredTouch& first, const StoredTouch& again,
                                            double apart_m, double agreement_m) const {
  const std::string detail = fmt::format("touch {}, {:.3f} mm apart from its repetition", first.number,
                                         calib::mm_from_metres(apart_m));
  if (apart_m <= agreement_m) return Confirmed{{FaultCode::kTouchOutlier, detail}};
  calib::OnlineArmEstimate aim = suspect_->without;
  if (aim.add(to_touch(again)).contradicts) return Held{{FaultCode::kTouchDoesNotFit, detail}};
  return Replaced{again, std::move(aim)};
}

}  // namespace cell
