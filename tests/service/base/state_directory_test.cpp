#include "service/base/state_directory.hpp"

#include <gtest/gtest.h>

#include <cstdlib>
#include <stdexcept>

#include "tests/config/folder.hpp"

namespace cell {
namespace {

TEST(StateDirectory, IsInTheStateHomeOfTheUser) {
  ::setenv("XDG_STATE_HOME", "/state", 1);
  EXPECT_EQ(default_state_directory(), "/state/touchcal");
  ::unsetenv("XDG_STATE_HOME");
  ::setenv("HOME", "/home/operator", 1);
  EXPECT_EQ(default_state_directory(), "/home/operator/.local/state/touchcal");
}

TEST(StateDirectory, IsADirectoryOrCanBeMadeInOne) {
  const Folder folder;
  EXPECT_EQ(demand_state_directory(folder.path() / "new" / "state"), folder.path());
  EXPECT_EQ(demand_state_directory(folder.path()), folder.path());
  folder.write("in-the-way", "a file");
  for (const auto& state : {folder.path() / "in-the-way", folder.path() / "in-the-way" / "state"}) {
    try {
      demand_state_directory(state);
      ADD_FAILURE() << state;
    } catch (const std::runtime_error& error) {
      EXPECT_EQ(error.what(), "--state " + state.string() + ": " + (folder.path() / "in-the-way").string() +
                                  " is not a directory; name another");
    }
  }
}

}  // namespace
}  // namespace cell
