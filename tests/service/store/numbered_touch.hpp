#pragma once

#include <string>

#include "service/store/run_store.hpp"

namespace cell {

/// Touches that differ by their number; one a second.
inline StoredTouch touch_of_number(int number) {
  return {.number = number,
          .plane = 1,
          .joints = {number, 2, 3, 4, 5, 6},
          .captured_at = "2026-01-02T00:00:0" + std::to_string(number) + ".000Z",
          .session = 1,
          .sequence = static_cast<std::uint32_t>(number)};
}

}  // namespace cell
