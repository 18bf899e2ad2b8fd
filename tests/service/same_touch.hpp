#pragma once

#include "service/store/run_store.hpp"

namespace cell {

// For EXPECT_EQ on what comes back.
inline bool operator==(const StoredTouch& a, const StoredTouch& b) {
  return a.number == b.number && a.plane == b.plane && a.role == b.role && a.joints == b.joints &&
         a.source == b.source && a.overtravel_dmm == b.overtravel_dmm && a.captured_at == b.captured_at &&
         a.session == b.session && a.sequence == b.sequence && a.aimed_with == b.aimed_with &&
         a.noise_um == b.noise_um && a.first == b.first && a.again == b.again;
}

}  // namespace cell
