// What a store says of a file that it cannot open, and that it leaves the file as it is.
#include <SQLiteCpp/SQLiteCpp.h>
#include <gmock/gmock.h>

#include <string>

#include "service/store/run_store.hpp"
#include "tests/config/folder.hpp"
#include "tests/service/store/numbered_touch.hpp"

namespace cell {
namespace {

using ::testing::HasSubstr;

/// What opening `file` fails with; the test fails when it does not.
std::string refusal_of_store(const std::filesystem::path& file) {
  try {
    const RunStore store(file);
  } catch (const std::exception& error) {
    return error.what();
  }
  ADD_FAILURE() << file << " was opened";
  return {};
}

TEST(RunStoreFile, OfANewerSchemaIsRefusedAndLeftAsItIs) {
  const Folder folder;
  const auto file = folder.path() / "touchcal.sqlite";
  {
    RunStore store(file);
    const std::int64_t run = store.begin_run({.recipe = "edf-25", .started_at = "start"});
    store.append_touch(run, touch_of_number(1));
  }
  const auto version = [&file] {
    SQLite::Database database(file.string(), SQLite::OPEN_READWRITE);
    return database.execAndGet("PRAGMA user_version").getInt();
  };
  const int ours = version();
  SQLite::Database(file.string(), SQLite::OPEN_READWRITE)
      .exec("PRAGMA user_version = " + std::to_string(ours + 1));
  const std::string told = refusal_of_store(file);
  EXPECT_THAT(told, HasSubstr(file.string()));
  EXPECT_THAT(told, HasSubstr("newer touchcald"));
  EXPECT_EQ(version(), ours + 1);
}

TEST(RunStoreFile, ThatIsNoDatabaseIsRefusedByNameAndLeftAsItIs) {
  const Folder folder;
  const std::string bytes(4096, 'x');
  const auto file = folder.write("notes.sqlite", bytes);
  EXPECT_THAT(refusal_of_store(file), HasSubstr(file.string()));
  EXPECT_EQ(bytes_of(file), bytes);
}

TEST(RunStoreFile, InAFolderThatIsNotThereIsToldByName) {
  const Folder folder;
  const auto file = folder.path() / "gone" / "touchcal.sqlite";
  EXPECT_THAT(refusal_of_store(file), HasSubstr(file.string()));
}

}  // namespace
}  // namespace cell
