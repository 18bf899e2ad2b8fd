#include "service/base/durable_file.hpp"

#include <gmock/gmock.h>
#include <sys/stat.h>

#include <fstream>
#include <iterator>
#include <stdexcept>

#include "tests/config/folder.hpp"

namespace cell {
namespace {

std::string bytes_of(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

TEST(DurableFile, HoldsWhatWasWrittenLastAndIsItsOwnersOnly) {
  const Folder folder;
  const auto file = folder.path() / "kept";
  replace_file(file, "the first, which is longer");
  replace_file(file, "the second");
  EXPECT_EQ(bytes_of(file), "the second");
  struct stat found {};
  ASSERT_EQ(::stat(file.c_str(), &found), 0);
  EXPECT_EQ(found.st_mode & 0777U, 0600U);
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder.path()), {}), 1) << "nothing beside it";
}

TEST(DurableFile, StaysAsItWasWhereItCannotBeWritten) {
  const Folder folder;
  const auto file = folder.path() / "kept";
  replace_file(file, "there");
  std::filesystem::create_directory(folder.path() / "kept.new");
  EXPECT_THROW(replace_file(file, "other"), std::runtime_error);
  EXPECT_EQ(bytes_of(file), "there");
}

TEST(DurableFile, GoesOnceAndThatItIsNotThereIsNoError) {
  const Folder folder;
  const auto file = folder.path() / "kept";
  replace_file(file, "there");
  remove_file(file);
  EXPECT_FALSE(std::filesystem::exists(file));
  remove_file(file);
  try {
    remove_file(folder.path());
    FAIL() << "a directory is no file";
  } catch (const std::runtime_error& error) {
    EXPECT_THAT(error.what(), ::testing::HasSubstr(folder.path().string()));
  }
}

}  // namespace
}  // namespace cell
