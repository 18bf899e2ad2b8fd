#include "sim_controller/motion_task.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "cs8_protocol/wire_units.hpp"
#include "sim_controller/admission.hpp"

namespace sim {
namespace {

using cs8::Outcome;

constexpr int kReseatTicksMax = static_cast<int>(kReseatSecondsMax / kTickSeconds);
constexpr int kStandstillTicksMax = static_cast<int>(kStandstillSecondsMax / kTickSeconds);

double metres_per_second(std::int32_t um_s) { return cs8::metres_per_second_from_um_s(um_s); }

/// One step of one command.
class MotionStep {
 public:
  MotionStep(const Plant& plant, Cabinet& cabinet, MotionTask& task, const CabinetTick& seen, TimePoint at)
      : plant_(plant),
        cabinet_(cabinet),
        retract_path_(task.retract_path),
        running_(*task.running),
        seen_(seen),
        at_(at) {}

  bool run() {
    follow_retract_path();
    ++running_.ticks_in_stage;
    if (seen_.sensed.collision) return collide();
    if (cabinet_.drives.error != 0 && running_.stage != Stage::kBreakOff && !search_line_ended()) {
      break_off(cabinet_, running_, Outcome::kMotionError, cabinet_.drives.error);
      return false;
    }
    if (wire_failed()) {
      break_off(cabinet_, running_, Outcome::kProbeFault);
      return false;
    }
    switch (running_.stage) {
      case Stage::kTravel:
        return travel();
      case Stage::kApproach:
        return approach();
      case Stage::kReady:
        return begin_search(touch().search_speed_um_s);
      case Stage::kSearch:
        return search();
      case Stage::kTripped:
        return tripped();
      case Stage::kBackOff:
        if (has_arrived()) enter(Stage::kReseat);
        return false;
      case Stage::kReseat:
        return reseat();
      case Stage::kRetract:
        return retract();
      case Stage::kLastReseat:
        return last_reseat();
      case Stage::kBreakOff:
        return broken_off();
      case Stage::kReturn:
        return returned();
    }
    return true;
  }

 private:
  const cs8::Touch& touch() const { return std::get<cs8::Touch>(running_.order); }

  void enter(Stage stage) {
    running_.stage = stage;
    running_.ticks_in_stage = 0;
  }

  /// The way back begins where the arm is now.
  void follow_retract_path() {
    if (retract_path_.empty() || !seen_.motion.path || running_.stage == Stage::kTravel) return;
    retract_path_.front().from = seen_.motion.path_to;
  }

  bool not_free() const { return !cabinet_.world.probe.inputs.free() || seen_.sensed.edges > 0; }

  bool collide() {
    running_.outcome = Outcome::kCollision;
    running_.broken_in = phase_of(running_.stage);
    running_.collision = *seen_.sensed.collision;
    reset_motion(cabinet_.drives);
    return true;
  }

  /// A cable that is cut or shorted ends whatever relies on the probe; a Retract does not.
  bool wire_failed() const {
    return cabinet_.probe_disagrees() && running_.stage != Stage::kBreakOff &&
           !std::holds_alternative<cs8::Retract>(running_.order);
  }

  /// Nothing is left to travel and the arm rests; drives that never say so are not waited for for ever.
  bool has_arrived() {
    const bool stands = is_empty(cabinet_.drives) && cabinet_.drives.standing_ticks > 0;
    running_.unsettled_ticks = stands ? running_.unsettled_ticks + 1 : 0;
    return cabinet_.arm_rests() || running_.unsettled_ticks > kStandstillTicksMax;
  }

  // ---- the way there ----

  bool travel() {
    if (not_free()) {
      break_off(cabinet_, running_, Outcome::kUnexpectedContact);
    } else if (has_arrived()) {
      if (!std::holds_alternative<cs8::Touch>(running_.order)) return true;
      movej(plant_, cabinet_.drives, joints_from_wire(touch().approach),
            metres_per_second(touch().approach_speed_um_s));
      retract_path_ = {begun_path()};
      enter(Stage::kApproach);
    }
    return false;
  }

  /// The move just queued, as a way back from its beginning.
  Stretch begun_path() const {
    if (cabinet_.drives.queue.empty()) return {{cabinet_.drives.joints, cabinet_.drives.joints}, 0.0, 0.0};
    return {*cabinet_.drives.queue.back().path, 0.0, 0.0};
  }

  bool approach() {
    if (not_free()) {
      break_off(cabinet_, running_, Outcome::kUnexpectedContact);
    } else if (has_arrived()) {
      enter(Stage::kReady);
    }
    return false;
  }

  // ---- the search ----

  bool begin_search(std::int32_t speed_um_s) {
    if (!cabinet_.probe_free()) {
      break_off(cabinet_, running_, Outcome::kUnexpectedContact);
      return false;
    }
    if (!running_.first) {  // the second touch finds the arm and the face as the first one did
      sim::begin_search(plant_, cabinet_.world, cabinet_.chance);
      movel(plant_, cabinet_.drives, joints_from_wire(touch().search_end), metres_per_second(speed_um_s));
      retract_path_.insert(retract_path_.begin(), begun_path());
    } else {
      Stretch again = retract_path_.front();
      again.to = 1.0;
      follow(plant_, cabinet_.drives, std::move(again), metres_per_second(speed_um_s));
    }
    running_.search_speed_um_s = speed_um_s;
    running_.last.reset();
    running_.latch_armed = true;
    enter(Stage::kSearch);
    return false;
  }

  /// The line ends where the arm cannot follow it; an edge may come in that tick all the same.
  bool search_line_ended() const {
    return (running_.stage == Stage::kSearch && not_free()) || running_.stage == Stage::kTripped;
  }

  bool search() {
    running_.monitor_speed_percent =
        std::min(running_.monitor_speed_percent, cabinet_.panel.monitor_speed_percent);
    if (not_free()) {
      running_.last = Capture{.at = at_};
      running_.edges = 0;  // until here those of the trigger before count
      running_.stop_in_ticks =
          std::max(0, static_cast<int>(std::lround(plant_.stop_latency_s / kTickSeconds)) - 1);
      enter(Stage::kTripped);
      return tripped();
    }
    if (has_arrived()) {
      running_.outcome = Outcome::kNoContact;
      return begin_retract();
    }
    return false;
  }

  /// Behind the trigger: reads the latch, brakes, waits until arm and inputs are still.
  bool tripped() {
    Capture& capture = *running_.last;
    running_.edges += static_cast<std::uint32_t>(seen_.sensed.edges);
    if (running_.latch_armed && seen_.sensed.edge_share) {
      running_.latch_armed = false;
      capture.source = cs8::CaptureSource::kLatched;
      capture.contact = encoder_reading(plant_, seen_.motion.at(*seen_.sensed.edge_share));
    } else if (running_.ticks_in_stage == 0) {
      capture.source = cs8::CaptureSource::kPolled;
      capture.contact = encoder_reading(plant_, seen_.motion.to);
    }
    if (running_.stop_in_ticks-- == 0) reset_motion(cabinet_.drives);
    if (running_.stop_in_ticks >= -1 || !cabinet_.arm_rests()) return stuck_moving();
    if (!cabinet_.probe_touched() && !cabinet_.probe_free()) return stuck_moving();
    return judge(capture);
  }

  /// At rest behind the trigger.
  bool judge(Capture& capture) {
    capture.stopped = encoder_reading(plant_, cabinet_.drives.joints);
    if (cabinet_.probe_free()) {  // the edge was noise: nothing holds the stylus
      running_.last.reset();
      running_.outcome = Outcome::kNoContact;
      return begin_retract();
    }
    capture.overtravel_m = tip_distance_m(plant_, capture.contact, *capture.stopped);
    const bool second_follows = touch().second_speed_um_s > 0 && !running_.first;
    running_.outcome = capture.overtravel_m > plant_.overtravel_m ? Outcome::kOvertravel : Outcome::kContact;
    if (running_.outcome == Outcome::kContact && second_follows) return begin_back_off();
    return begin_retract();
  }

  /// What is captured next is the contact; what was is the first one, whether there is a next or not.
  bool begin_back_off() {
    running_.first = std::exchange(running_.last, std::nullopt);
    Stretch back = retract_path_.front();
    const double length_m = tip_distance_m(plant_, back.path.front(), back.path.back());
    const double share = cs8::metres_from_dmm(touch().second_backoff_dmm) / length_m;
    back.to = std::max(0.0, back.from - share);
    follow(plant_, cabinet_.drives, std::move(back), metres_per_second(touch().approach_speed_um_s));
    enter(Stage::kBackOff);
    return false;
  }

  bool reseat() {
    if (cabinet_.probe_free()) return begin_search(touch().second_speed_um_s);
    if (running_.ticks_in_stage < kReseatTicksMax) return false;
    running_.outcome = Outcome::kProbeStuck;
    return begin_retract();
  }

  // ---- the way back ----

  std::int32_t retract_speed_um_s() const {
    if (const auto* order = std::get_if<cs8::Touch>(&running_.order)) return order->approach_speed_um_s;
    return std::get<cs8::Retract>(running_.order).approach_speed_um_s;
  }

  bool begin_retract() {
    enter(Stage::kRetract);
    return next_stretch();
  }

  bool next_stretch() {
    if (retract_path_.empty()) {
      if (std::holds_alternative<cs8::Retract>(running_.order)) return true;
      enter(Stage::kLastReseat);
      return false;
    }
    follow(plant_, cabinet_.drives, retract_path_.front(), metres_per_second(retract_speed_um_s()));
    return false;
  }

  bool retract() {
    if (back_tripped()) {
      break_off(cabinet_, running_, Outcome::kUnexpectedContact);
      return false;
    }
    if (!has_arrived()) return false;
    retract_path_.erase(retract_path_.begin());
    return next_stretch();
  }

  /// The way back of a touch is watched from where the probe has seated again; a Retract may go with a bent
  /// stylus.
  bool back_tripped() {
    if (std::holds_alternative<cs8::Retract>(running_.order)) return false;
    running_.seated = running_.seated || cabinet_.probe_free();
    return running_.seated && not_free();
  }

  bool last_reseat() {
    if (cabinet_.probe_free()) return true;
    if (running_.ticks_in_stage < kReseatTicksMax) return false;
    running_.outcome = Outcome::kProbeStuck;
    return true;
  }

  // ---- early ends ----

  /// An arm that does not come to rest is not waited for for ever.
  bool stuck_moving() {
    if (running_.ticks_in_stage < kStandstillTicksMax) return false;
    running_.outcome = Outcome::kMotionError;
    running_.error_number = kTimeoutError;
    if (running_.broken_in == cs8::Phase::kIdle) running_.broken_in = phase_of(running_.stage);
    return true;
  }

  bool broken_off() {
    if (!cabinet_.arm_rests()) return stuck_moving();
    const bool by_edge = running_.outcome == Outcome::kUnexpectedContact;
    if (by_edge && running_.ticks_in_stage < kSteadyTicks) return false;
    if (by_edge && cabinet_.probe_disagrees()) running_.outcome = Outcome::kProbeFault;
    if (running_.last && !running_.last->stopped)  // broken off between trigger and standstill
      running_.last->stopped = encoder_reading(plant_, cabinet_.drives.joints);
    const bool goes_back = running_.outcome == Outcome::kStopped && !running_.returning &&
                           running_.broken_in == cs8::Phase::kSearch && retract_path_.size() > 1;
    if (!goes_back) return true;
    running_.returning = true;
    follow(plant_, cabinet_.drives, retract_path_.front(), metres_per_second(retract_speed_um_s()));
    enter(Stage::kReturn);
    return false;
  }

  bool returned() {
    if (!has_arrived()) return false;
    retract_path_.erase(retract_path_.begin());
    return true;
  }

  const Plant& plant_;
  Cabinet& cabinet_;
  std::vector<Stretch>& retract_path_;
  RunningCommand& running_;
  const CabinetTick& seen_;
  TimePoint at_;
};

template <class Order>
RunningCommand begin(std::uint32_t sequence, const Order& order, Stage stage, Outcome outcome) {
  return {.sequence = sequence, .order = order, .stage = stage, .outcome = outcome};
}

void travel_through(const Plant& plant, Cabinet& cabinet, const std::vector<calib::JointVector>& waypoints,
                    double speed_m_s) {
  for (const calib::JointVector& joints : waypoints) movej(plant, cabinet.drives, joints, speed_m_s);
}

}  // namespace

cs8::Phase phase_of(Stage stage) {
  switch (stage) {
    case Stage::kTravel:
      return cs8::Phase::kTravel;
    case Stage::kApproach:
    case Stage::kReady:
      return cs8::Phase::kApproach;
    case Stage::kSearch:
    case Stage::kTripped:
    case Stage::kBackOff:
    case Stage::kReseat:
      return cs8::Phase::kSearch;
    case Stage::kRetract:
    case Stage::kLastReseat:
    case Stage::kReturn:
      return cs8::Phase::kRetract;
    case Stage::kBreakOff:
      break;
  }
  return cs8::Phase::kIdle;
}

RunningCommand begin_touch(const Plant& plant, Cabinet& cabinet, std::uint32_t sequence,
                           const cs8::Touch& order) {
  const TouchMotion motion = touch_motion(order);
  travel_through(plant, cabinet, motion.waypoints, motion.travel_speed_m_s);
  return begin(sequence, order, Stage::kTravel, Outcome::kContact);
}

RunningCommand begin_travel(const Plant& plant, Cabinet& cabinet, std::uint32_t sequence,
                            const cs8::Travel& order) {
  travel_through(plant, cabinet, travel_waypoints(order), metres_per_second(order.travel_speed_um_s));
  return begin(sequence, order, Stage::kTravel, Outcome::kArrived);
}

RunningCommand begin_retract(const Plant& plant, Cabinet& cabinet, const std::vector<Stretch>& retract_path,
                             std::uint32_t sequence, const cs8::Retract& order) {
  follow(plant, cabinet.drives, retract_path.front(), metres_per_second(order.approach_speed_um_s));
  return begin(sequence, order, Stage::kRetract, Outcome::kArrived);
}

void break_off(Cabinet& cabinet, RunningCommand& running, Outcome outcome, std::int32_t error_number) {
  if (running.stage == Stage::kBreakOff) return;
  if (running.stage != Stage::kReturn) {  // a stopped search that is broken off again was stopped first
    running.outcome = outcome;
    running.broken_in = phase_of(running.stage);
    running.error_number = error_number;
  } else if (outcome != Outcome::kStopped) {
    running.outcome = outcome;
    running.error_number = error_number;
  }
  running.stage = Stage::kBreakOff;
  running.ticks_in_stage = 0;
  reset_motion(cabinet.drives);
}

bool step(const Plant& plant, Cabinet& cabinet, MotionTask& task, const CabinetTick& seen, TimePoint at) {
  return MotionStep(plant, cabinet, task, seen, at).run();
}

}  // namespace sim
