#include "service/base/state_directory.hpp"

#include <gtest/gtest.h>

#include <cstdlib>

namespace cell {
namespace {

TEST(StateDirectory, IsInTheStateHomeOfTheUser) {
  ::setenv("XDG_STATE_HOME", "/state", 1);
  EXPECT_EQ(default_state_directory(), "/state/touchcal");
  ::unsetenv("XDG_STATE_HOME");
  ::setenv("HOME", "/home/operator", 1);
  EXPECT_EQ(default_state_directory(), "/home/operator/.local/state/touchcal");
}

}  // namespace
}  // namespace cell
