#pragma once

#include <cmath>

#include "service/report/report_document.hpp"
#include "tests/service/table3_result.hpp"

namespace cell {

/// The paper's touches as a controller would have answered them, and what they gave.
inline RunRecord calibrated_run() {
  RunRecord made{.run = {.id = 7, .recipe = "edf-25", .touches_total = 0, .started_at = "then"},
                 .result_json = {}};
  const auto touches = table3_touches();
  for (const calib::Touch& touch : touches) {
    StoredTouch stored{
        .number = static_cast<int>(made.touches.size()) + 1, .plane = touch.face + 1, .role = touch.role};
    for (std::size_t i = 0; i < stored.joints.size(); ++i)
      stored.joints[i] = static_cast<std::int32_t>(
          std::lround(touch.joints[static_cast<Eigen::Index>(i)] * 180e6 / 3.14159265358979323846));
    made.touches.push_back(stored);
  }
  made.result_json = result().dump();
  return made;
}

}  // namespace cell
