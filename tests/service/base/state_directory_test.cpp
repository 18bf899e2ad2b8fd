#include "service/base/state_directory.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <stdexcept>
#include <string>

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

std::string refusal(void (*demand)(const std::filesystem::path&), const std::filesystem::path& directory) {
  try {
    demand(directory);
  } catch (const std::runtime_error& error) {
    return error.what();
  }
  return "";
}

TEST(StateDirectory, MayNotBeALinkToWhatIsNotThere) {
  const Folder folder;
  const auto link = folder.path() / "link";
  std::filesystem::create_symlink(folder.path() / "gone", link);
  for (const auto& state : {link, link / "below"}) {
    const auto demand = [](const std::filesystem::path& at) { demand_state_directory(at); };
    EXPECT_EQ(refusal(demand, state),
              "--state " + state.string() + ": " + link.string() + " is a link to " +
                  (folder.path() / "gone").string() +
                  ", which is not there; make that directory, remove the link, or name another");
  }
  std::filesystem::create_directory(folder.path() / "gone");
  EXPECT_EQ(demand_state_directory(link), link);
}

TEST(StateDirectory, IsNotOneThatOthersMayWriteIn) {
  using std::filesystem::perms;
  const Folder folder;
  EXPECT_EQ(refusal(demand_closed_directory, folder.path() / "new"), "") << "it is made for its owner";
  for (const perms taken : {perms(0700), perms(0755), perms(0750)}) {
    std::filesystem::permissions(folder.path(), taken);
    EXPECT_EQ(refusal(demand_closed_directory, folder.path()), "");
  }
  for (const perms others : {perms(0777), perms(0770), perms(0702), perms(01777)}) {
    std::filesystem::permissions(folder.path(), others);
    EXPECT_EQ(refusal(demand_closed_directory, folder.path()),
              "--state " + folder.path().string() +
                  ": others than its owner may write into it, and could put a token there; look at what is "
                  "there, then chmod 700 " +
                  folder.path().string() +
                  "; where its mount decides the rights, mount it for this user alone (dir_mode=0700, no "
                  "fsGroup), or name another");
  }
}

TEST(StateDirectory, IsNotAnotherUsers) {
  const Folder folder;
  EXPECT_EQ(refusal(demand_own_directory, folder.path()), "");
  EXPECT_EQ(refusal(demand_own_directory, folder.path() / "new"), "");
  EXPECT_EQ(refusal(demand_own_directory, "/"), "") << "root's is taken";
  if (::geteuid() != 0) GTEST_SKIP() << "only root gives directories away";
  ASSERT_EQ(::chown(folder.path().c_str(), 65534, 65534), 0);
  const std::string told = refusal(demand_own_directory, folder.path());
  EXPECT_EQ(told.substr(0, told.find(';')),
            "--state " + folder.path().string() +
                ": belongs to the user with the id 65534, and touchcald runs as 0");
  EXPECT_NE(told.find("chown -R 0 " + folder.path().string()), std::string::npos);
}

}  // namespace
}  // namespace cell
