#pragma once

#include "config/cell.hpp"
#include "config/read_config.hpp"
#include "config/touches_file.hpp"
#include "tests/config/folder.hpp"

namespace cell {

/// The paper's cell as it is shipped.
inline const Cell& edf() {
  static const Cell cell = read_cell(kSourceDir / "config/cells/edf/cell.json");
  return cell;
}

/// 100 exact touches of an arm that has the errors of Table III.
inline const std::vector<calib::Touch>& table3_touches() {
  static const std::vector<calib::Touch> touches =
      read_touches(kSourceDir / "tests/data/table3-exact.touches.json", edf()).touches;
  return touches;
}

}  // namespace cell
