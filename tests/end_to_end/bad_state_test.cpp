// Files of a state directory that something changed: bits, the end, a stretch of zeros, all of it. Whatever
// it was, what only looks at them ends by itself, and says which file it was where it refuses one.
#include <gmock/gmock.h>

#include <algorithm>
#include <fstream>
#include <functional>
#include <iterator>
#include <random>

#include "config/read_config.hpp"
#include "service/base/exit_code.hpp"
#include "service/base/state_directory.hpp"
#include "service/documents/block_pose_file.hpp"
#include "service/documents/locating_file.hpp"
#include "service/http/auth/tokens.hpp"
#include "service/store/maintenance.hpp"
#include "service/store/run_store.hpp"
#include "tests/end_to_end/folder.hpp"
#include "tests/end_to_end/process.hpp"

namespace touchcal::testing {
namespace {

namespace fs = std::filesystem;

class BadState : public ::testing::Test {
 protected:
  BadState() {
    folder_.directory("state/" + std::string(cell::kOperatorsDirectory));
    {
      cell::RunStore store(state_ / cell::kStoreFile);
      for (int run = 0; run < 3; ++run) {
        const std::int64_t id =
            store.begin_run({.recipe = "edf-25", .started_at = "2026-11-25T08:00:00.000Z"});
        for (int touch = 1; touch <= 30; ++touch)
          store.append_touch(id, {.number = touch, .plane = 1, .joints = {touch, 2, 3, 4, 5, 6}});
        store.finish_run(id, {.outcome = cell::RunOutcome::kComplete, .result_json = "{\"a\":1}"});
      }
    }
    cell::mark_begun(state_);
    cell::load_or_make_tokens(state_);
    write(std::string(cell::kOperatorsDirectory) + "/ada", cell::random_hex(32) + "\n");
    fs::permissions(state_ / cell::kOperatorsDirectory / "ada",
                    fs::perms::owner_read | fs::perms::owner_write);
    cell::BlockPose place{.cell_from_block = Eigen::Isometry3d::Identity(),
                          .covariance = 1e-8 * Eigen::Matrix<double, 6, 6>::Identity(),
                          .std_block_pose = {},
                          .touches = {},
                          .located_at = "2026-11-22T03:00:00.000Z",
                          .digest = "digest"};
    cell::LocatingRecord record{.config_digest = "digest", .from_place = {}, .touches = {}};
    for (int touch = 0; touch < 6; ++touch) {
      place.touches.push_back({touch / 3, calib::JointVector::Constant(0.1 * touch), 1e-4});
      record.touches.push_back({{touch, 2, 3, 4, 5, 6}, 1e-5, "2026-11-24T08:00:00.000Z"});
    }
    cell::write_block_pose(state_ / cell::kBlockPoseFile, place);
    cell::write_locating(state_ / cell::kLocatingFile, record);
  }

  std::string read(const std::string& file) const {
    std::ifstream stream(state_ / file, std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), {}};
  }
  void write(const std::string& file, const std::string& bytes) const {
    std::ofstream(state_ / file, std::ios::binary) << bytes;
  }
  std::size_t lot(std::size_t bound) {
    return std::uniform_int_distribution<std::size_t>(0, bound - 1)(chance_);
  }

  std::string changed(std::string bytes) {
    const std::size_t at = lot(bytes.size());
    switch (lot(20)) {
      case 0:
        return {};
      case 1:
        return bytes + bytes;
      case 2:
        return std::string(bytes.size(), '\0');
      case 3:
      case 4:
        return bytes.substr(0, at);
      case 5:
      case 6:
      case 7: {
        const std::size_t length = std::min<std::size_t>(1 + lot(600), bytes.size() - at);
        return bytes.replace(at, length, std::string(length, '\0'));
      }
      default:
        for (std::size_t flips = 1 + lot(3); flips > 0; --flips) {
          char& byte = bytes[lot(bytes.size())];
          byte = static_cast<char>(byte ^ (1 << lot(8)));
        }
        return bytes;
    }
  }

  Finished run(const std::vector<std::string>& command) const {
    std::vector<std::string> arguments{"touchcald", "--state", state_.string()};
    arguments.insert(arguments.end(), command.begin(), command.end());
    return Process(arguments, folder_ / "call.err").wait();
  }
  Finished check() const {
    return run({"--check", "--cell", std::string(TOUCHCAL_SOURCE_DIR) + "/config/cells/edf/cell.json",
                "--listen", "127.0.0.1:0"});
  }
  Finished verify() const { return run({"--verify"}); }
  Finished back_up() {
    const fs::path copy = folder_ / "copy";
    const Finished finished = run({"--backup", copy.string()});
    fs::remove(copy);
    fs::remove(copy.string() + ".place.json");
    return finished;
  }

  /// What a newer version has written is no damage: of that alone nobody can say, which is the exit code 5.
  void expect_an_end(const Finished& finished, const std::string& file, const std::string& what) {
    if (finished.exit_code == cell::kExitDone) return;
    ++refused_;
    const std::string line = finished.err.substr(0, finished.err.find('\n'));
    EXPECT_THAT(line, ::testing::HasSubstr(file)) << what;
    if (finished.exit_code == cell::kExitFailed) {
      EXPECT_THAT(line, ::testing::HasSubstr("a newer touchcald wrote it")) << what;
      return;
    }
    EXPECT_GE(finished.exit_code, cell::kExitUsage) << what << '\n' << finished.err;
    EXPECT_LE(finished.exit_code, cell::kExitRefused) << what << '\n' << finished.err;
  }

  void change_and_look(const std::string& file, int times,
                       const std::vector<std::function<Finished()>>& commands) {
    const std::string sound = read(file);
    for (const auto& command : commands) ASSERT_EQ(command().exit_code, cell::kExitDone) << "as it was";
    for (int time = 0; time < times && !HasFailure(); ++time) {
      const std::string bytes = changed(sound);
      for (const auto& command : commands) {
        write(file, bytes);
        expect_an_end(command(), file,
                      file + ", change " + std::to_string(time) + " of seed " + std::to_string(kSeed));
        for (const char* beside : {"-wal", "-shm", "-journal"}) fs::remove(state_ / (file + beside));
      }
    }
    write(file, sound);
  }

  static constexpr std::uint64_t kSeed = 15;
  Folder folder_;
  const fs::path state_ = folder_ / "state";
  std::mt19937_64 chance_{kSeed};
  int refused_ = 0;
};

TEST_F(BadState, ADatabaseIsLookedAtWhateverItHolds) {
  change_and_look(std::string(cell::kStoreFile), 200,
                  {[this] { return verify(); }, [this] { return back_up(); }});
  change_and_look(std::string(cell::kStoreFile), 100, {[this] { return check(); }});
  EXPECT_GT(refused_, 90);
}

TEST_F(BadState, APlaceIsLookedAtWhateverItHolds) {
  change_and_look(std::string(cell::kBlockPoseFile), 200, {[this] { return check(); }});
  EXPECT_GT(refused_, 150);
}

TEST_F(BadState, ADialogueIsLookedAtWhateverItHolds) {
  change_and_look(std::string(cell::kLocatingFile), 200, {[this] { return check(); }});
  EXPECT_EQ(refused_, 0) << "it is discarded";
  write(std::string(cell::kLocatingFile), "{");
  EXPECT_THAT(check().out, ::testing::HasSubstr(cell::kLocatingFile));
}

TEST_F(BadState, TokensAreLookedAtWhateverTheyHold) {
  for (const std::string& file : {std::string(cell::kOperateTokenFile), std::string(cell::kViewTokenFile),
                                  std::string(cell::kOperatorsDirectory) + "/ada"})
    change_and_look(file, 60, {[this] { return check(); }});
  EXPECT_GT(refused_, 50);
}

}  // namespace
}  // namespace touchcal::testing
