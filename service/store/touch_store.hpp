#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "calib_core/touch.hpp"
#include "cs8_protocol/messages.hpp"

namespace SQLite {
class Database;
}

namespace cell {

/// A touch as it was answered, exact: joints in the controller's own 10^-6 degrees.
struct StoredTouch {
  int number = 0;  // place in the run's plan, from 1
  int plane = 0;   // from 1
  calib::TouchRole role = calib::TouchRole::kFit;
  cs8::JointsMicrodeg joints{};
  cs8::CaptureSource source = cs8::CaptureSource::kLatched;
  int overtravel_dmm = 0;
  std::string captured_at;  // RFC 3339
};

struct NewRun {
  std::string recipe;
  int touches_total = 0;
  std::string started_at;
  std::optional<std::string> idempotency_key;
};

/// How a run ended. `outcome`: complete, stopped, aborted, interrupted (the daemon went away during it).
struct RunEnd {
  std::string outcome;
  std::string verdict;
  std::string ended_at;
  std::optional<std::string> fault_code;
  std::optional<std::string> fault_message;
  std::optional<std::string> result_json;  // the result document as it was served last
};

struct StoredRun {
  std::int64_t id = 0;
  std::string recipe;
  int touches_total = 0;
  int touches_done = 0;
  std::string started_at;
  std::optional<std::string> ended_at;
  std::string outcome;  // running until it ended
  std::string verdict;
  std::optional<std::string> fault_code;
  std::optional<std::string> fault_message;
};

/// Runs and touches in one SQLite file (WAL, synchronous FULL): what a call wrote is durable when it returns.
/// Every call may throw std::exception when the file cannot be read or written.
class TouchStore {
 public:
  /// Opens or creates the file. A file of a newer schema is refused.
  explicit TouchStore(const std::filesystem::path& file);
  ~TouchStore();
  TouchStore(const TouchStore&) = delete;
  TouchStore& operator=(const TouchStore&) = delete;

  std::int64_t begin_run(const NewRun& run);
  /// What the run follows, known once it is planned: how many touches, and the plan as it was shown. A plan
  /// that several runs follow is kept once.
  void set_plan(std::int64_t run_id, int touches_total, const std::string& plan_id,
                const std::string& document);
  /// A run that is accurate enough leaves out touches of its plan.
  void set_touches_total(std::int64_t run_id, int touches_total);
  void append_touch(std::int64_t run_id, const StoredTouch& touch);
  void finish_run(std::int64_t run_id, const RunEnd& end);
  /// Replaces the result of a run that ended.
  void set_result_json(std::int64_t run_id, const std::string& result_json);
  /// Ends runs that a previous daemon left open, as interrupted; returns how many.
  int finish_interrupted(const std::string& now);

  /// Newest first; only runs before `before_id` when given.
  [[nodiscard]] std::vector<StoredRun> runs(int limit, std::optional<std::int64_t> before_id = {}) const;
  [[nodiscard]] std::optional<StoredRun> run(std::int64_t id) const;
  [[nodiscard]] std::optional<StoredRun> run_with_key(const std::string& idempotency_key) const;
  [[nodiscard]] std::optional<StoredRun> last_accepted() const;
  [[nodiscard]] std::vector<StoredTouch> touches(std::int64_t run_id) const;
  [[nodiscard]] std::optional<std::string> result_json(std::int64_t run_id) const;
  /// The document of the plan that the run follows.
  [[nodiscard]] std::optional<std::string> plan_json(std::int64_t run_id) const;

 private:
  std::unique_ptr<SQLite::Database> database_;
};

}  // namespace cell
