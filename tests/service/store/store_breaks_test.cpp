// Whatever breaks a run's writing, and wherever: what a call wrote before is there, nothing is half there.
#include <SQLiteCpp/SQLiteCpp.h>
#include <gmock/gmock.h>
#include <sqlite3.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <functional>

#include "service/store/audit_log.hpp"
#include "service/store/fault_log.hpp"
#include "service/store/maintenance.hpp"
#include "service/store/run_store.hpp"
#include "tests/config/folder.hpp"

namespace cell {
namespace {

constexpr int kTouches = 4;

/// Each touch takes a page of its own, so that any of them may find the disk full.
const std::string kLongText(1500, 't');

StoredTouch numbered_touch(int number) {
  return {.number = number,
          .plane = 1,
          .joints = {number, 2, 3, 4, 5, 6},
          .captured_at = kLongText,
          .session = 1,
          .sequence = static_cast<std::uint32_t>(number)};
}

/// A short run as the daemon stores it; `stored` is told how many touches are stored for good, as the
/// controller is, which forgets them then.
void store_a_run(RunStore& store, const std::function<void(int)>& stored) {
  FaultLog faults(store.database());
  AuditLog audit(store.database());
  audit.append_command({.at = "t", .action = "POST /api/v1/runs"});
  const std::int64_t run = store.begin_run({.recipe = "edf-25", .started_at = "start"});
  store.set_plan(run, kTouches, "plan", "{}");
  store.append_reference(run, {.number = 1, .captured_at = "t"});
  for (int number = 1; number <= kTouches; ++number) {
    const auto sequence = static_cast<std::uint32_t>(number);
    if (number == 2) store.append_plan_change(run, {PlanChange::Kind::kDefer, 2});
    store.set_open_command(run, {.session = 1, .sequence = sequence, .touch_json = "{}"});
    store.make_durable(run);
    store.append_touch(run, numbered_touch(number));
    stored(number);
  }
  faults.append(run, "t", "no_contact", "");
  StoredTouch again = numbered_touch(2);
  again.sequence = kTouches + 1;
  store.replace_touch(run, again, "outlier");
  store.finish_run(run, {.outcome = RunOutcome::kComplete, .verdict = Verdict::kAccepted, .ended_at = "end"});
}

/// Counts commits, before and after each, and ends the process at the n-th.
struct Killer {
  int at = 0;
  int count = 0;
  void step() {
    if (++count == at) _exit(9);
  }
};

/// In a process of its own; how it ended, and the last touch that was told to be stored.
struct Ended {
  int status = 0;
  int stored = 0;
};
Ended run_apart(const std::function<void(const std::function<void(int)>&)>& work) {
  int ends[2];
  if (pipe(ends) != 0) throw std::runtime_error("no pipe");
  const pid_t child = fork();
  if (child == 0) {
    try {
      work([&](int number) {
        const char byte = static_cast<char>(number);
        if (write(ends[1], &byte, 1) != 1) _exit(8);
      });
    } catch (const std::exception&) {
      _exit(7);
    }
    _exit(0);
  }
  close(ends[1]);
  Ended ended;
  char byte = 0;
  while (read(ends[0], &byte, 1) == 1) ended.stored = byte;
  close(ends[0]);
  int status = 0;
  waitpid(child, &status, 0);
  ended.status = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  return ended;
}

void expect_whole(const std::filesystem::path& file, int stored, const std::string& where) {
  EXPECT_THAT(find_damage(file), ::testing::IsEmpty()) << where;
  const RunStore store(file);
  const auto runs = store.runs(10);
  ASSERT_LE(runs.size(), 1u) << where;
  if (runs.empty()) {
    EXPECT_EQ(stored, 0) << where;
    return;
  }
  const auto touches = store.touches(runs[0].id);
  // One more may have been stored when there was no time left to tell it.
  EXPECT_GE(static_cast<int>(touches.size()), stored) << where;
  EXPECT_LE(static_cast<int>(touches.size()), stored + 1) << where;
  for (std::size_t i = 0; i < touches.size(); ++i) EXPECT_EQ(touches[i].number, static_cast<int>(i) + 1);
  for (const StoredTouch& each : touches) EXPECT_EQ(each.joints, numbered_touch(each.number).joints) << where;
  const bool replaced = !store.superseded_touches(runs[0].id).empty();
  EXPECT_EQ(replaced, touches.size() > 1 && touches[1].sequence == kTouches + 1) << where;
  if (runs[0].outcome == RunOutcome::kRunning && !touches.empty() && !replaced) {
    const auto open = store.open_command(runs[0].id);
    if (open) {
      EXPECT_EQ(open->sequence, touches.size() + 1) << where;
    }
  }
}

TEST(StoreBreaks, KilledAtAnyCommitItComesBackWithEveryTouchThatWasTold) {
  bool ended = false;
  for (int at = 1; !ended; ++at) {
    ASSERT_LT(at, 200) << "the run never comes to its end";
    const Folder folder;
    const auto file = folder.path() / "touchcal.sqlite";
    const Ended result = run_apart([&](const auto& stored) {
      RunStore store(file);
      Killer killer{.at = at};
      sqlite3_commit_hook(
          store.database()->getHandle(),
          [](void* killer) {
            static_cast<Killer*>(killer)->step();
            return 0;
          },
          &killer);
      sqlite3_wal_hook(
          store.database()->getHandle(),
          [](void* killer, sqlite3*, const char*, int) {
            static_cast<Killer*>(killer)->step();
            return 0;
          },
          &killer);
      store_a_run(store, stored);
    });
    ended = result.status == 0;
    EXPECT_TRUE(ended || result.status == 9) << result.status;
    if (ended) {
      EXPECT_EQ(result.stored, kTouches);
    }
    expect_whole(file, result.stored, "killed at " + std::to_string(at));
  }
}

TEST(StoreBreaks, OnADiskThatIsFullAtAnyPageNothingIsHalfThere) {
  int refused = 0;
  for (int pages = 0; pages <= kTouches; ++pages) {
    const Folder folder;
    const auto file = folder.path() / "touchcal.sqlite";
    const Ended result = run_apart([&](const auto& stored) {
      RunStore store(file);
      store.database()->exec("VACUUM");  // no page is free in it
      const int used = store.database()->execAndGet("PRAGMA page_count").getInt();
      store.database()->exec("PRAGMA max_page_count = " + std::to_string(used + pages));
      store_a_run(store, stored);
    });
    refused += result.status == 7 ? 1 : 0;
    EXPECT_TRUE(result.status == 0 || result.status == 7) << result.status;
    expect_whole(file, result.stored, std::to_string(pages) + " pages left");
  }
  EXPECT_GE(refused, kTouches);
}

TEST(StoreBreaks, AFileThatMayNotGrowFailsTheCallAndNotTheProcess) {
  for (const rlim_t log_bytes : {0, 4'000, 20'000, 60'000}) {
    const Folder folder;
    const auto file = folder.path() / "touchcal.sqlite";
    const Ended result = run_apart([&](const auto& stored) {
      RunStore store(file);
      store.database()->exec("PRAGMA wal_checkpoint(TRUNCATE)");
      std::signal(SIGXFSZ, SIG_IGN);
      const rlimit limit{log_bytes, log_bytes};
      setrlimit(RLIMIT_FSIZE, &limit);
      store_a_run(store, stored);
    });
    EXPECT_EQ(result.status, 7);
    expect_whole(file, result.stored, std::to_string(log_bytes) + " bytes of log");
  }
}

}  // namespace
}  // namespace cell
