#include "service/cli/setup_directory.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include "config/read_config.hpp"
#include "tests/service/setup/made_cell.hpp"

namespace cell {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;

CellFiles files_named(const std::string& name) {
  SetupAnswers answers;
  answers.name = name;
  answers.block.name = name;
  return files_of(answers);
}

/// Fails at the n-th step, or ends the process there as a loss of power does.
BeforeStep breaking(int n, bool ends_process) {
  return [n, ends_process, at = 0](const char* step) mutable {
    if (at++ != n) return;
    if (ends_process) _exit(7);
    throw std::runtime_error(std::string("broken: ") + step);
  };
}

/// Whether it went through.
bool written(const fs::path& directory, const CellFiles& files, int n, bool ends_process) {
  if (!ends_process) {
    try {
      write_cell_directory(directory, files, breaking(n, false));
      return true;
    } catch (const std::runtime_error& error) {
      EXPECT_THAT(error.what(), HasSubstr("cannot be written (broken: "));
      return false;
    }
  }
  const pid_t child = fork();
  if (child == 0) {
    write_cell_directory(directory, files, breaking(n, true));
    _exit(0);
  }
  int status = 0;
  waitpid(child, &status, 0);
  return WEXITSTATUS(status) == 0;
}

bool holds(const fs::path& directory, const CellFiles& files) {
  return changed_by_hand(directory, files).empty();
}

class BrokenAtEachStep : public ::testing::TestWithParam<bool> {};

TEST_P(BrokenAtEachStep, AChangeLeavesTheOldCellOrTheNewOneAndAMixtureIsNeverRead) {
  const CellFiles old_files = files_named("old"), new_files = files_named("new");
  int refused = 0, n = 0;
  for (bool is_through = false; !is_through; ++n) {
    SCOPED_TRACE(n);
    ASSERT_LT(n, 100);
    const Folder folder;
    const fs::path directory = folder.path() / "cell";
    write_cell_directory(directory, old_files);
    folder.write("cell/notes.txt", "a person's own");
    is_through = written(directory, new_files, n, GetParam());
    try {
      const std::string read = read_cell(directory / kSetupCellFile).name;
      EXPECT_TRUE(holds(directory, read == "old" ? old_files : new_files)) << read;
    } catch (const ConfigError& error) {
      ++refused;
      EXPECT_THAT(error.what(), HasSubstr("touchcal setup"));
      EXPECT_TRUE(complete_change(directory));
      EXPECT_TRUE(holds(directory, new_files));
    }
    // And the next change goes through.
    write_cell_directory(directory, new_files);
    EXPECT_EQ(read_cell(directory / kSetupCellFile).name, "new");
    EXPECT_FALSE(fs::exists(directory / ".setup-new"));
    EXPECT_FALSE(complete_change(directory));
    EXPECT_EQ(bytes_of(directory / "notes.txt"), "a person's own");
  }
  EXPECT_GT(refused, 0) << "no step lay between the old cell and the new one";
}

TEST_P(BrokenAtEachStep, ANewDirectoryIsThereWholeOrNotAtAll) {
  const CellFiles files = files_named("new");
  for (int n = 0, is_through = 0; is_through == 0; ++n) {
    SCOPED_TRACE(n);
    ASSERT_LT(n, 100);
    const Folder folder;
    const fs::path directory = folder.path() / "cell";
    is_through = written(directory, files, n, GetParam()) ? 1 : 0;
    EXPECT_EQ(fs::exists(directory), is_through == 1);
    if (is_through == 0) write_cell_directory(directory, files);
    EXPECT_TRUE(holds(directory, files));
  }
}

INSTANTIATE_TEST_SUITE_P(ByFailureAndByLossOfPower, BrokenAtEachStep, ::testing::Bool());

}  // namespace
}  // namespace cell
