#pragma once

#include <string>
#include <vector>

#include "tests/twins/record.hpp"

namespace twins {

/// Something that the two twins did not do alike.
struct Difference {
  std::string where;  // "touch_result.overtravel_dmm", "order", "state.phase", "time", "place"
  std::string fast;   // the C++ twin
  std::string val3;
};

std::vector<Difference> differences(const Record& fast, const Record& val3);
/// Both records' messages, one line each, side by side.
std::string side_by_side(const Record& fast, const Record& val3);

}  // namespace twins
