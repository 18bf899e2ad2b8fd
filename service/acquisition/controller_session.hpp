#pragma once

#include <atomic>
#include <boost/asio/awaitable.hpp>
#include <chrono>
#include <cstdint>
#include <functional>
#include <optional>
#include <set>
#include <span>
#include <string>

#include "calib_core/geometry/joint_vector.hpp"
#include "calib_core/planning/touch_planning.hpp"
#include "config/cell.hpp"
#include "service/acquisition/controller.hpp"
#include "service/acquisition/permission_watch.hpp"
#include "service/acquisition/published_status.hpp"
#include "service/acquisition/reconnect_pause.hpp"
#include "service/acquisition/wake.hpp"
#include "service/base/clocks.hpp"
#include "service/run/readiness.hpp"
#include "service/run/touch_command.hpp"

namespace cell {

/// A touch whose result was not acknowledged yet: the controller still has it.
struct OpenTouch {
  std::uint32_t session = 0;
  std::uint32_t sequence = 0;
  calib::PlannedTouch planned;  // as it was aimed
  int aimed_with = 0;           // as StoredTouch::aimed_with
  std::int64_t run_id = 0;      // whose touch it is: no other run may keep it
};

/// What is known of the controller across connections: the link, the permit, the command still open there,
/// and where the arm is. Every command goes through here. A lost link ends a wait without a result and is
/// reported by the controller's hooks, not from here; every other failure is raised at the status.
class ControllerSession {
 public:
  /// All must outlive it. Of `cell` the arm, the speeds and the deadlines are used.
  ControllerSession(const Cell& cell, Controller& controller, PublishedStatus& status, Wake& wake,
                    Clocks clocks);

  // What the controller reports.
  void on_controller_state(const cs8::State& state);
  /// Raises a failed task of the controller, with this event. Call it after on_controller_state and the
  /// state's other uses.
  void check_task(const cs8::State& state, Event event);
  void on_permit(const cs8::Permit& permit);
  /// With each heartbeat that is sent: holds a run whose controller tells no State any more.
  void on_heartbeat();
  /// A person's stop: sent at once, whenever there is a link.
  void stop();
  /// A stop that nobody asked for: the motion under way ends, and its answer `stopped` is no fault.
  void stop_motion();
  /// A new state of the cell: stops the arm where the state asks for it and returns a requested permit.
  void on_entered(State state);

  [[nodiscard]] bool connected() const { return controller_.connected(); }
  [[nodiscard]] std::optional<cs8::State> latest_state() const { return controller_.latest_state(); }
  /// The shown state; `probe` stays while its two inputs change one after the other.
  [[nodiscard]] ControllerView view(const std::optional<std::string>& probe) const;
  /// The age of the newest State; nothing before the first. From any thread.
  [[nodiscard]] std::optional<std::int64_t> data_age_ms() const;
  /// The controller's application: the session, one per start of it; its name and version as it reported
  /// them.
  [[nodiscard]] std::uint32_t number() const { return number_; }
  [[nodiscard]] const std::optional<std::string>& application() const { return application_; }

  /// Tries until there is a link, the state changes or the daemon ends. Moves nothing. Returns the sequence
  /// of a command that the controller still has and that must be settled now; 0 without one. The fault that
  /// holds a run stays. `run_interrupted`: by the end of the daemon before.
  /// `gives_up`: asked between two tries, for what else is to be done; 0 then too.
  boost::asio::awaitable<std::uint32_t> connect(bool run_interrupted, std::function<bool()> gives_up = {});
  void close();
  /// The link was lost. Why a run ended or is on hold stays to be read.
  void on_link_lost(const cs8::LinkError& error, Event event);

  /// Obtains a person's permit before anything moves (PROTOCOL.md, section 7), for the run of this number,
  /// 0 where it is none. True when it is given; else a fault or a command has entered another state, or in
  /// RESETTING a person has jogged the arm back, which it was for.
  boost::asio::awaitable<bool> obtain_permit(std::uint32_t run_number);
  void give_permit_back();
  /// The same in the middle of a run: a person confirms it again before it goes on.
  void end_permit();
  /// A person has confirmed this run, and nothing has ended that since.
  [[nodiscard]] bool has_permit(std::uint32_t run_number) const;
  /// What State says against the motion that is under way, in words; empty when it says nothing.
  [[nodiscard]] std::string lost_permission() const { return permission_.told(); }
  /// A fault that lost permission caused, with what the controller tells of it: its State, and why the permit
  /// ended. Any other as it is.
  [[nodiscard]] Fault with_permission_told(Fault fault) const;
  /// Why the controller will not make one of these touches: what it said in its Welcome of the searches that
  /// it takes.
  [[nodiscard]] std::optional<Fault> search_fault(std::span<const calib::PlannedTouch> touches) const;
  /// The longest search that it takes, metres; empty before it said so.
  [[nodiscard]] std::optional<double> search_length_max_m() const;

  // The command that is open at the controller.
  [[nodiscard]] const std::optional<OpenTouch>& open_touch() const { return open_touch_; }
  void set_open_touch(OpenTouch touch) { open_touch_ = std::move(touch); }
  void drop_open_touch() { open_touch_.reset(); }
  /// 0 when nothing is open.
  [[nodiscard]] std::uint32_t sequence_to_settle() const;
  boost::asio::awaitable<cs8::QueryReply> query(std::uint32_t sequence);
  /// Lets the controller forget a touch. Only when its answer is stored, or holds nothing to store.
  void acknowledge(std::uint32_t sequence);
  /// The same of an answer that is no measurement of a run: where its contact was stays in the log.
  /// `run_id`: nothing where the store has no run.
  void discard(std::optional<std::int64_t> run_id, std::uint32_t sequence, const cs8::TouchResult& result);
  /// An answer that came and is not stored yet, of a command that is no open touch: until acknowledge().
  void note_unsettled(std::uint32_t sequence) { unsettled_sequence_ = sequence; }

  [[nodiscard]] std::uint32_t next_sequence() const { return controller_.next_sequence(); }
  /// The command is sent before this returns; await the reply at once. Where the permit has ended nothing is
  /// sent, and the reply is the refusal that the controller would give.
  boost::asio::awaitable<cs8::TouchReply> touch(cs8::Touch command);
  /// True when the arm has arrived. Where the permit has ended nothing is sent, and that is raised.
  boost::asio::awaitable<bool> travel(cs8::Travel command);
  /// Handles a command that ended stopped: by a person's request, or else it is a fault.
  void expect_stop(cs8::Outcome outcome);
  /// A controller that missed an acknowledgement, that runs a command this side does not know of, or that
  /// counts otherwise is met anew: the end of the link stops what moves, and its Welcome names the result
  /// that it still has and its last number.
  void meet_anew_after(const cs8::Rejected& rejected);

  // Where the last command left the arm, when that is certain.
  [[nodiscard]] const std::optional<calib::JointVector>& standing() const { return standing_; }
  void set_standing(const calib::JointVector& joints) { standing_ = joints; }
  void forget_standing() { standing_.reset(); }
  /// Says what a person at the cell is waited for; null when for nothing.
  void wait_for(const AwaitedAction* awaited);
  /// The arm's joints, clear of the faces: after an interrupted search the arm first goes back along the
  /// search line. Empty when that failed, the link is lost or another state was entered.
  boost::asio::awaitable<std::optional<calib::JointVector>> standing_joints();
  /// Retracts before the daemon ends: a stop may have left the stylus at a face. A failure leaves the arm
  /// where it is, and so does a person's stop.
  boost::asio::awaitable<void> leave_face();

 private:
  boost::asio::awaitable<void> take_refused_permit(const cs8::Permit& permit, std::optional<cs8::State> told,
                                                   std::chrono::steady_clock::time_point ready_by);
  boost::asio::awaitable<void> wait_until_readier(std::optional<cs8::State> told,
                                                  std::chrono::steady_clock::time_point at_latest);
  void on_welcome(const cs8::Welcome& welcome, State state, bool run_interrupted);
  /// The refusal of a command for which there is no permit any more: it must not be sent.
  [[nodiscard]] std::optional<cs8::Rejected> refusal_without_permit() const;
  bool take_move(const cs8::MoveReply& reply);
  [[nodiscard]] Event event_of(const OutcomeFault& fault) const;
  [[nodiscard]] bool is_moving_state() const;
  [[nodiscard]] bool is_watched() const;
  [[nodiscard]] Event hold_or_abort() const;
  /// Whether the newest Permit of this connection is one for the way back from a face.
  [[nodiscard]] bool may_retract() const;
  void raise_link_fault(Fault fault, Event event);
  void hold_without_permission();
  boost::asio::awaitable<std::optional<cs8::State>> settled_state();

  const Cell& cell_;
  Controller& controller_;
  PublishedStatus& status_;
  Wake& wake_;
  Clocks clocks_;
  std::uint32_t number_ = 0;
  std::optional<std::string> application_;
  std::optional<std::uint32_t> overruns_;  // of the controller's tasks, as reported
  std::optional<Readiness> readiness_;     // as reported last
  std::uint32_t unsettled_sequence_ = 0;   // that Welcome named, or note_unsettled(), until it is settled
  std::optional<OpenTouch> open_touch_;
  std::optional<calib::JointVector> standing_;
  std::optional<std::chrono::steady_clock::time_point> state_at_;  // when the newest state was received
  std::int32_t task_error_ = 0;                                    // in that state
  int inputs_disagree_count_ = 0;                                  // newest states of the controller in a row
  bool inputs_disagreed_ = false;                                  // since a permit was asked for
  bool asking_ = false;                                            // for a permit
  int stop_count_ = 0;                                             // stops of a person
  bool stop_sent_ = false;                                         // since the last command
  std::optional<std::uint32_t> permitted_run_;  // from the confirmation until the permit is given back
  bool is_doubted_ = false;                     // the permit: State says that there is none
  PermissionWatch permission_;
  ReconnectPause pause_;
  std::set<std::string> told_faults_;       // of links, since one of them lasted
  std::optional<Fault> loss_;               // how the last link ended
  std::int32_t search_length_max_dmm_ = 0;  // of Welcome, 10^-4 mm; 0 is unknown
  std::int32_t search_speed_max_um_s_ = 0;
  /// state_at_ for other threads; the least value before the first.
  std::atomic<std::chrono::steady_clock::time_point> told_at_{std::chrono::steady_clock::time_point::min()};
};

}  // namespace cell
