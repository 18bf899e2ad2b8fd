#include "service/base/known_directory.hpp"

#include <gtest/gtest.h>

#include "tests/config/folder.hpp"

namespace cell {
namespace {

namespace fs = std::filesystem;
using Found = KnownDirectory::Found;

TEST(KnownDirectory, IsItselfAlsoWhereItIsBackAfterAMove) {
  const Folder folder;
  const fs::path place = folder.path() / "state", moved = folder.path() / "moved";
  fs::create_directory(place);
  const KnownDirectory known(place);
  EXPECT_EQ(known.look(), Found::kItself);
  fs::rename(place, moved);
  EXPECT_EQ(known.look(), Found::kNothing);
  fs::create_directory(place);
  EXPECT_EQ(known.look(), Found::kAnother);
  fs::remove(place);
  fs::rename(moved, place);
  folder.write("state/file", "more in it");
  EXPECT_EQ(known.look(), Found::kItself);
}

TEST(KnownDirectory, ALinkThatLeadsElsewhereNamesAnother) {
  const Folder one, other;
  const fs::path link = one.path() / "link";
  fs::create_directory(one.path() / "state");
  fs::create_directory_symlink(one.path() / "state", link);
  const KnownDirectory known(link);
  EXPECT_EQ(known.look(), Found::kItself);
  fs::remove(link);
  fs::create_directory_symlink(other.path(), link);
  EXPECT_EQ(known.look(), Found::kAnother);
}

TEST(KnownDirectory, OneThatWasNotThereIsNotFoundLater) {
  const Folder folder;
  const KnownDirectory known(folder.path() / "later");
  fs::create_directory(folder.path() / "later");
  EXPECT_EQ(known.look(), Found::kNothing) << "who made it is not known";
}

}  // namespace
}  // namespace cell
