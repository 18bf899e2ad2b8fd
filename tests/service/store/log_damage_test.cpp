#include "service/store/log_damage.hpp"

#include <SQLiteCpp/SQLiteCpp.h>
#include <gmock/gmock.h>

#include <fstream>
#include <sstream>

#include "service/store/maintenance.hpp"
#include "service/store/run_store.hpp"
#include "tests/config/folder.hpp"

namespace cell {
namespace {

namespace fs = std::filesystem;
using ::testing::Contains;
using ::testing::HasSubstr;

constexpr std::size_t kHeader = 32, kFrame = 24 + 4096;

std::string content(const fs::path& file) {
  std::ostringstream all;
  all << std::ifstream(file, std::ios::binary).rdbuf();
  return all.str();
}

/// The files of a daemon that was killed in a run: each touch was committed before the controller was told.
class BrokenOffLog : public ::testing::Test {
 protected:
  static constexpr int kStored = 20;

  BrokenOffLog() {
    const Folder running;
    RunStore store(running.path() / "touchcal.sqlite");
    const std::int64_t run = store.begin_run({.recipe = "edf-25", .started_at = "start"});
    for (int number = 1; number <= kStored; ++number) {
      store.set_open_command(
          run, {.session = 1, .sequence = static_cast<std::uint32_t>(number), .touch_json = "{}"});
      store.make_durable(run);
      store.append_touch(run, {.number = number, .plane = 1, .captured_at = "t"});
    }
    log_ = content(running.path() / "touchcal.sqlite-wal");
    folder_.write("touchcal.sqlite", content(running.path() / "touchcal.sqlite"));
    while (kHeader + (frames_ + 1) * kFrame <= log_.size() &&
           log_.substr(kHeader + frames_ * kFrame + 8, 8) == log_.substr(16, 8))
      ++frames_;
  }
  [[nodiscard]] fs::path file() const { return folder_.path() / "touchcal.sqlite"; }
  std::optional<std::string> damage_of(const std::string& log) {
    folder_.write("touchcal.sqlite-wal", log);
    return find_log_damage(file());
  }
  [[nodiscard]] std::string flipped(std::size_t at) const {
    std::string log = log_;
    log[at] = static_cast<char>(log[at] ^ 0x10);
    return log;
  }
  [[nodiscard]] static std::size_t in_frame(std::size_t frame, std::size_t at) {
    return kHeader + frame * kFrame + at;
  }

  Folder folder_;
  std::string log_;
  std::size_t frames_ = 0;  // of the run: what is behind them is left over from before
};

TEST_F(BrokenOffLog, IsWholeAlsoWithWhatIsLeftOverBehindIt) {
  EXPECT_GE(frames_, static_cast<std::size_t>(2 * kStored));
  EXPECT_GT(log_.size(), in_frame(frames_ + 10, 0));
  EXPECT_EQ(damage_of(log_), std::nullopt);
  EXPECT_EQ(damage_of(""), std::nullopt);
  EXPECT_EQ(find_log_damage(folder_.path() / "none"), std::nullopt);
}

TEST_F(BrokenOffLog, MayEndAnywhere) {
  for (std::size_t bytes = 0; bytes < in_frame(frames_, 0); bytes += 1009)
    EXPECT_EQ(damage_of(log_.substr(0, bytes)), std::nullopt) << bytes;
}

TEST_F(BrokenOffLog, LosesAnsweredTouchesByOneBitWhichIsTold) {
  const std::size_t at = frames_ / 4;
  for (const std::size_t byte : {1, 9, 17, 200}) {  // page number, salt, checksum, page
    const auto damage = damage_of(flipped(in_frame(at, byte)));
    ASSERT_TRUE(damage) << byte;
    EXPECT_THAT(*damage, HasSubstr("-wal: frame " + std::to_string(at + 1) + " is not"));
  }
  EXPECT_THAT(find_damage(file()), Contains(HasSubstr("-wal: frame ")));
  SQLite::Database reopened(file().string(), SQLite::OPEN_READWRITE);
  EXPECT_EQ(reopened.execAndGet("PRAGMA integrity_check").getString(), "ok") << "SQLite says nothing";
  EXPECT_LT(reopened.execAndGet("SELECT count(*) FROM touches").getInt(), kStored);
}

TEST_F(BrokenOffLog, LosesAllByOneBitOfItsHeaderWhichIsTold) {
  for (std::size_t byte = 0; byte < kHeader; ++byte) EXPECT_TRUE(damage_of(flipped(byte))) << byte;
}

TEST_F(BrokenOffLog, IsNoDamageWherePowerFailedBeforeTheLastCommitsWereOnTheDisk) {
  for (std::size_t behind = 1; behind <= static_cast<std::size_t>(kUnsyncedCommitsMax); ++behind)
    EXPECT_EQ(damage_of(flipped(in_frame(frames_ - behind, 200))), std::nullopt) << behind;
}

}  // namespace
}  // namespace cell
