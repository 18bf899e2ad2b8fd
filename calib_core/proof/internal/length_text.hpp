#pragma once

#include <string>

namespace calib {

/// A length as people read it: "0.021 mm".
std::string length_text(double metres);

}  // namespace calib
