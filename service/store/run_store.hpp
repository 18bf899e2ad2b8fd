#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "calib_core/geometry/touch.hpp"
#include "cs8_protocol/messages.hpp"
#include "service/store/schema.hpp"

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
  /// The command that it answers: a session of the controller's application and a number in it; 0 when
  /// unknown.
  std::uint32_t session = 0;
  std::uint32_t sequence = 0;
  int aimed_with = 0;  // how many touches aimed it; kNominalMiss when it was made with the nominal miss
};
inline constexpr int kNominalMiss = -1;

/// A touch that was made again, and why.
struct SupersededTouch {
  StoredTouch touch;
  std::string reason;
};

/// A touch at the run's reference place: not one of the plan, and never fitted.
struct ReferenceTouch {
  int number = 0;        // from 1
  int touches_done = 0;  // of the run, when it was made
  cs8::JointsMicrodeg joints{};
  std::optional<double> drift_mm;  // against the first one
  std::string captured_at;         // RFC 3339
};

/// A touch command that was sent and whose answer is not stored yet: by this the answer is known again after
/// a restart.
struct OpenCommand {
  std::uint32_t session = 0;  // of the controller's application
  std::uint32_t sequence = 0;
  int aimed_with = 0;      // as StoredTouch::aimed_with
  std::string touch_json;  // the touch as it was aimed
};

/// A run's plan is the one that it was planned with, and then these, in their order.
struct PlanChange {
  enum class Kind { kPutOff, kDropFitted, kSkip };
  Kind kind = Kind::kPutOff;
  int place = 0;  // in the plan as it was then, from 0
};

struct NewRun {
  std::string recipe;
  int touches_total = 0;
  std::string started_at;
  std::optional<std::string> idempotency_key;
  std::optional<std::string> operator_name;
  std::optional<double> block_temperature_c;
  std::optional<std::string> config_digest;  // of the cell's files
  std::optional<std::string> trace_json;  // versions, temperatures, controller: an object, free in its keys
};

/// How a run ended. `outcome`: complete, stopped, aborted, interrupted (the daemon went away during it, and
/// it was not resumed).
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
  std::optional<std::string> plan_id;
  std::optional<std::string> operator_name;
  std::optional<double> block_temperature_c;
  std::optional<std::string> config_digest;
  std::optional<std::string> trace_json;
};

/// Runs and touches in one SQLite file: what a call wrote is durable when it returns, where it does not say
/// otherwise. Every call may throw std::exception when the file cannot be read or written; nothing of that
/// call is in the file then.
class TouchStore {
 public:
  /// Opens or creates the file. A file of a newer schema is refused.
  explicit TouchStore(const std::filesystem::path& file);
  ~TouchStore();
  TouchStore(const TouchStore&) = delete;
  TouchStore& operator=(const TouchStore&) = delete;

  /// The connection, for the other parts that keep to the same file.
  [[nodiscard]] const SharedDatabase& database() const { return database_; }

  std::int64_t begin_run(const NewRun& run);
  /// What the run follows, known once it is planned: how many touches, and the plan as it was shown. A plan
  /// that several runs follow is kept once.
  void set_plan(std::int64_t run_id, int touches_total, const std::string& plan_id,
                const std::string& document);
  /// A run that is accurate enough leaves out touches of its plan.
  void set_touches_total(std::int64_t run_id, int touches_total);
  /// Durable with the next touch: before that the plan is changed again in the same way.
  void append_plan_change(std::int64_t run_id, const PlanChange& change);
  /// Call it before the command is sent: it outlives this process then. make_durable(), called while the arm
  /// moves, lets it outlive the machine as well; false when that fails, which the next call that writes
  /// tells.
  void set_open_command(std::int64_t run_id, const OpenCommand& command);
  bool make_durable(std::int64_t run_id);
  void append_touch(std::int64_t run_id, const StoredTouch& touch);
  /// `again` takes the place of the touch with its number, which is kept apart.
  void replace_touch(std::int64_t run_id, const StoredTouch& again, const std::string& reason);
  /// The touch counts no more and is kept apart.
  void withdraw_touch(std::int64_t run_id, int number, const std::string& reason);
  void append_reference(std::int64_t run_id, const ReferenceTouch& touch);
  void append_resumption(std::int64_t run_id, const std::string& at, int touches_done);
  void finish_run(std::int64_t run_id, const RunEnd& end);
  /// Replaces the result of a run that ended.
  void set_result_json(std::int64_t run_id, const std::string& result_json);
  /// Ends runs that a previous daemon left open, as interrupted, all but `but`; returns how many.
  int finish_interrupted(const std::string& now, std::optional<std::int64_t> but = {});

  /// Newest first; only runs before `before_id` when given.
  [[nodiscard]] std::vector<StoredRun> runs(int limit, std::optional<std::int64_t> before_id = {}) const;
  [[nodiscard]] std::optional<StoredRun> run(std::int64_t id) const;
  [[nodiscard]] std::optional<StoredRun> run_with_key(const std::string& idempotency_key) const;
  [[nodiscard]] std::optional<StoredRun> last_accepted() const;
  /// The newest run that has not ended.
  [[nodiscard]] std::optional<StoredRun> running() const;
  [[nodiscard]] std::vector<StoredTouch> touches(std::int64_t run_id) const;
  [[nodiscard]] std::vector<SupersededTouch> superseded_touches(std::int64_t run_id) const;  // oldest first
  [[nodiscard]] std::vector<ReferenceTouch> references(std::int64_t run_id) const;
  /// The last touch command of the run, unless its answer is stored.
  [[nodiscard]] std::optional<OpenCommand> open_command(std::int64_t run_id) const;
  [[nodiscard]] std::vector<PlanChange> plan_changes(std::int64_t run_id) const;
  [[nodiscard]] std::optional<std::string> result_json(std::int64_t run_id) const;
  /// The document of the plan that the run follows.
  [[nodiscard]] std::optional<std::string> plan_json(std::int64_t run_id) const;

 private:
  struct Statements;

  SharedDatabase database_;
  std::unique_ptr<Statements> statements_;  // those that a run uses at each touch, prepared once
};

}  // namespace cell
