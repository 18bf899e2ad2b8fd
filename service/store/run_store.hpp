#pragma once

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "calib_core/geometry/touch.hpp"
#include "cs8_protocol/messages.hpp"
#include "service/store/run_kind.hpp"
#include "service/store/run_outcome.hpp"
#include "service/store/schema.hpp"

namespace cell {

/// The first contact of a two-speed touch, at the speed of the search.
struct FirstContact {
  cs8::CaptureSource source = cs8::CaptureSource::kLatched;
  cs8::JointsMicrodeg joints{};

  bool operator==(const FirstContact&) const = default;
};

/// A touch exactly as the controller answered it: joints in 10^-6 degrees.
struct StoredTouch {
  int number = 0;  // place in the run's plan, from 1
  int plane = 0;   // from 1
  calib::TouchRole role = calib::TouchRole::kFit;
  cs8::JointsMicrodeg joints{};
  cs8::CaptureSource source = cs8::CaptureSource::kLatched;
  int overtravel_dmm = 0;
  std::string captured_at;  // RFC 3339
  /// The command that it answers: session of the controller's application and sequence number; 0 if unknown.
  std::uint32_t session = 0;
  std::uint32_t sequence = 0;
  int aimed_with = 0;  // number of touches in the estimate that aimed it; kNominalMiss: none was used
  /// One standard deviation along the normal, micrometres; nothing: that of any touch of the cell.
  std::optional<double> noise_um;
  std::optional<FirstContact> first;         // nothing of a touch with one contact
  std::optional<cs8::JointsMicrodeg> again;  // the contact of a repetition that agreed with this touch
};
inline constexpr int kNominalMiss = -1;

/// A touch that was repeated, and why.
struct SupersededTouch {
  StoredTouch touch;
  std::string reason;
};

/// A touch at the reference place of the run: not part of the plan, never fitted.
struct ReferenceTouch {
  int number = 0;        // from 1
  int touches_done = 0;  // of the run, at that time
  cs8::JointsMicrodeg joints{};
  std::optional<double> drift_mm;  // against the first one
  std::string captured_at;         // RFC 3339
};

/// A touch command whose answer is not stored yet: it identifies the answer after a restart.
struct OpenCommand {
  std::uint32_t session = 0;  // of the controller's application
  std::uint32_t sequence = 0;
  int aimed_with = 0;      // as StoredTouch::aimed_with
  std::string touch_json;  // the touch as it was aimed
};

/// One change of a run's plan; the plan of a run is its stored plan with all changes applied in order.
struct PlanChange {
  /// kBlockToMove: a person is asked to bring the block to a place, kBlockMoved: it stands there.
  enum class Kind { kDefer, kDropFitTouches, kSkip, kBlockToMove, kBlockMoved };
  Kind kind = Kind::kDefer;
  int place = 0;  // index in the plan at that time, from 0; of the block, that of its place in the recipe

  bool operator==(const PlanChange&) const = default;
};

/// A touch that is to count no longer, and why.
struct Withdrawal {
  int number = 0;
  std::string reason;
};

/// The temperature of the block that a run was started with.
struct StoredTemperature {
  double celsius = 0.0;
  std::optional<double> std_k;             // these three: nothing where an older daemon kept none
  std::optional<std::string> measured_at;  // RFC 3339; also nothing where nobody said when
  std::optional<std::string> source;       // "file" or "run"

  bool operator==(const StoredTemperature&) const = default;
};

struct NewRun {
  RunKind kind = RunKind::kCalibration;
  std::optional<std::int64_t> of_run;  // the calibration that is proved or checked
  std::string recipe;
  int touches_total = 0;
  std::string started_at;
  std::optional<std::string> idempotency_key;
  std::optional<std::string> operator_name;
  std::optional<StoredTemperature> block_temperature;
  std::optional<std::string> stiffness;      // "on", "off", "auto"; nothing: the recipe's
  std::optional<std::string> config_digest;  // of the cell's files
  std::optional<std::string>
      conditions_json;  // versions, temperatures, controller: an object, free in its keys
};

/// How a run ended.
struct RunEnd {
  RunOutcome outcome = RunOutcome::kComplete;
  Verdict verdict = Verdict::kNone;
  std::string ended_at;
  std::optional<std::string> fault_code;
  std::optional<std::string> fault_message;
  std::optional<std::string> result_json;  // the last result document
  std::optional<std::string> arm_json;     // the calibrated arm that goes with it, as a file
};

/// Where a run that was imported is from: RunImports in run_copy.hpp.
struct RunOrigin {
  std::string cell;         // its name
  std::int64_t run_id = 0;  // there
  std::string exported_at;  // RFC 3339, as the next
  std::string imported_at;
  std::string sha256;  // of the file

  bool operator==(const RunOrigin&) const = default;
};

struct StoredRun {
  std::int64_t id = 0;
  RunKind kind = RunKind::kCalibration;
  std::optional<std::int64_t> of_run;  // the calibration that is proved or checked
  std::string recipe;
  int touches_total = 0;
  int touches_done = 0;
  std::string started_at;
  std::optional<std::string> ended_at;
  RunOutcome outcome = RunOutcome::kRunning;
  Verdict verdict = Verdict::kNone;
  std::optional<std::string> fault_code;
  std::optional<std::string> fault_message;
  std::optional<std::string> plan_id;
  std::optional<std::string> operator_name;
  std::optional<StoredTemperature> block_temperature;
  std::optional<std::string> stiffness;  // in place of the recipe's
  std::optional<std::string> config_digest;
  std::optional<std::string> conditions_json;
  std::optional<RunOrigin> origin = {};  // nothing: it is of this daemon
};

/// The time that passes while another program has the file locked.
struct LockTime {
  std::function<void(std::chrono::milliseconds)> sleep;             // the machine's where there is none
  std::function<std::chrono::steady_clock::time_point()> now = {};  // none: it stands still
};

/// So long a write waits for another program's lock (a backup, a shell, a copy of the file) before it fails:
/// less than what a person is told of as a slow disk. Behind a lock that outlasts it nothing waits so long
/// again until a write has gone through, or for kLockLapse.
inline constexpr std::chrono::milliseconds kLockPatience{4000};
inline constexpr std::chrono::milliseconds kLockLapse{5000};

/// Runs and touches in one SQLite file. What a call writes is durable on return unless stated otherwise.
/// Every call may throw std::exception if the file cannot be read or written; it has changed nothing then.
/// Each row that a run rests on has a checksum, written with it and compared when it is read.
class RunStore {
 public:
  /// Opens or creates the file. A file of a newer schema is refused. `time`: what passes at
  /// the locks of other programs.
  explicit RunStore(const std::filesystem::path& file, LockTime time = {});
  /// Only reads, over its own connection, so that another thread may have it: open_database_to_read().
  static std::unique_ptr<const RunStore> reader(const std::filesystem::path& file);
  ~RunStore();
  RunStore(const RunStore&) = delete;
  RunStore& operator=(const RunStore&) = delete;

  /// The connection, shared with the other tables of the same file.
  [[nodiscard]] const SharedDatabase& database() const { return database_; }

  /// The file, for another connection.
  [[nodiscard]] std::filesystem::path file() const;

  /// Throws, with what to do, where the file was moved, removed or replaced since it was opened: who finds
  /// its directory by the path now is not who is meant.
  void demand_in_place() const;

  std::int64_t begin_run(const NewRun& run);
  /// Removes a run that was begun here and nowhere else: nobody was told of it, and its key is new again.
  void withdraw_run(std::int64_t run_id);
  /// Stores the plan of the run, once it is known, with what is changed of it at once. A plan of several runs
  /// is stored once.
  void set_plan(std::int64_t run_id, int touches_total, const std::string& plan_id,
                const std::string& document, const std::vector<PlanChange>& changes = {});
  /// Changes the number of touches: a run that is accurate enough leaves some out.
  void set_touches_total(std::int64_t run_id, int touches_total);
  /// Durable with the next touch; a lost change is made again in the same way.
  void append_plan_change(std::int64_t run_id, const PlanChange& change);
  /// Call it before the command is sent: it survives a crash of the process. make_durable(), called while the
  /// arm moves, lets it survive a power failure as well; false if that fails, which the next write reports.
  void set_open_command(std::int64_t run_id, const OpenCommand& command);
  bool make_durable(std::int64_t run_id);
  /// The command has not left after all. Durable with the next touch.
  void forget_open_command(std::int64_t run_id);
  /// One that is there as the answer to the same command stays as it is: who was broken off between the disk
  /// and the acknowledgement asks the controller for the answer again, and stores it again.
  void append_touch(std::int64_t run_id, const StoredTouch& touch);
  /// `again` replaces the touch of its number, which is kept as superseded. Where it has done so already
  /// nothing is written: who was told of a failure, or of nothing, tries it once more.
  void replace_touch(std::int64_t run_id, const StoredTouch& again, const std::string& reason);
  /// Keeps the contact of a repetition with the touch that it agrees with, which stays. It goes with the
  /// touch where that is replaced or withdrawn later.
  void confirm_touch(std::int64_t run_id, int number, const cs8::JointsMicrodeg& again);
  /// Removes the touch, which is kept as superseded.
  void withdraw_touch(std::int64_t run_id, int number, const std::string& reason);
  /// Changes of the plan by a person's word, the withdrawal of a touch with them: durable on return, all or
  /// none.
  void change_plan(std::int64_t run_id, const std::vector<PlanChange>& changes,
                   const std::optional<Withdrawal>& withdrawn = {});
  /// The same one once more is not written: who was told of a failure behind the disk tries it again.
  void append_reference(std::int64_t run_id, const ReferenceTouch& touch);
  void append_resumption(std::int64_t run_id, const std::string& at, int touches_done);
  void finish_run(std::int64_t run_id, const RunEnd& end);
  /// Replaces the result of a run that ended, and the arm that went with it.
  void set_result_json(std::int64_t run_id, const std::string& result_json,
                       const std::optional<std::string>& arm_json = {});
  /// Ends the runs that an earlier daemon left open, except `but`, as interrupted; returns how many.
  int finish_interrupted(const std::string& now, std::optional<std::int64_t> but = {});

  // What follows throws DamagedStore for a row that is not as it was written, for rows of a run that ended
  // and are gone, and for text that should be JSON and is not.

  /// Newest first; only runs before `before_id`, if given.
  [[nodiscard]] std::vector<StoredRun> runs(int limit, std::optional<std::int64_t> before_id = {}) const;
  [[nodiscard]] std::optional<StoredRun> run(std::int64_t id) const;
  [[nodiscard]] std::optional<StoredRun> run_with_key(const std::string& idempotency_key) const;
  /// The newest calibration of this daemon that was accepted. Nothing also where its row is damaged, which
  /// the log says: an older one would be a wrong answer.
  [[nodiscard]] std::optional<StoredRun> last_accepted() const;
  /// The newest run of this daemon of a kind that came to its end.
  [[nodiscard]] std::optional<StoredRun> last_complete(RunKind kind) const;
  /// The runs of a kind that are of this calibration and came to their end, by the time of it: one that was
  /// imported may be older than those before it.
  [[nodiscard]] std::vector<StoredRun> complete_runs_of(std::int64_t calibration, RunKind kind) const;
  /// The newest run that has not ended.
  [[nodiscard]] std::optional<StoredRun> running() const;
  [[nodiscard]] std::vector<StoredTouch> touches(std::int64_t run_id) const;
  [[nodiscard]] std::vector<SupersededTouch> superseded_touches(std::int64_t run_id) const;  // oldest first
  [[nodiscard]] std::vector<ReferenceTouch> references(std::int64_t run_id) const;
  /// The last touch command of the run, unless its answer is stored.
  [[nodiscard]] std::optional<OpenCommand> open_command(std::int64_t run_id) const;
  [[nodiscard]] std::vector<PlanChange> plan_changes(std::int64_t run_id) const;
  [[nodiscard]] std::optional<std::string> result_json(std::int64_t run_id) const;
  /// The calibrated arm that was stored when the run ended, as a file.
  [[nodiscard]] std::optional<std::string> arm_json(std::int64_t run_id) const;
  /// The document of the plan that the run follows.
  [[nodiscard]] std::optional<std::string> plan_json(std::int64_t run_id) const;

 private:
  struct Statements;
  explicit RunStore(SharedDatabase to_read);

  std::int64_t insert_run(const NewRun& run);
  void insert_touch(std::int64_t run_id, const StoredTouch& touch);

  SharedDatabase database_;
  std::unique_ptr<Statements> statements_;  // used at each touch, prepared once; null for a reader
};

}  // namespace cell
