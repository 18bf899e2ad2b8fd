#include "calib_core/proof/internal/length_text.hpp"

#include <gtest/gtest.h>

namespace calib {
namespace {

TEST(LengthText, IsInMillimetresToTheMicrometre) {
  EXPECT_EQ(length_text(0.0300004), "30.000 mm");
  EXPECT_EQ(length_text(21.4e-6), "0.021 mm");
  EXPECT_EQ(length_text(0.0), "0.000 mm");
}

}  // namespace
}  // namespace calib
