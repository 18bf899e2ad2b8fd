#include "sim_controller/timeline.hpp"

#include <algorithm>

#include "sim_controller/contact.hpp"

namespace sim {
namespace {

Leg timed_leg(const Plant& plant, cs8::Phase phase, Stretch stretch, double speed_m_s) {
  const double duration = duration_s(plant, stretch, speed_m_s);
  return {phase, std::move(stretch), duration};
}

void end_early(Timeline& timeline, cs8::Outcome outcome) {
  timeline.outcome = outcome;
  timeline.phase = timeline.legs.back().phase;
}

void end_in_collision(Timeline& timeline, const calib::Clash& clash) {
  end_early(timeline, cs8::Outcome::kCollision);
  timeline.collision = clash.body + " hit " + clash.other;
}

/// Adds a joint move in which neither the ball nor a body may touch; false when it ends the command.
bool add_guarded_move(const Plant& plant, Timeline& timeline, cs8::Phase phase,
                      const calib::JointVector& from, const calib::JointVector& to, double speed_m_s) {
  const Path path{from, to};
  const auto trip = find_trip(plant, path, 0.0);
  const auto hit = find_hit(plant, path, trip.value_or(1.0));
  const double end = hit ? hit->progress : trip.value_or(1.0);
  timeline.legs.push_back(timed_leg(plant, phase, {path, 0.0, end}, speed_m_s));
  if (hit) {
    end_in_collision(timeline, hit->clash);
  } else if (trip) {
    end_early(timeline, cs8::Outcome::kUnexpectedContact);
    timeline.way_out = way_out_from(timeline.legs, timeline.legs.size() - 1, 1.0);
  }
  return !hit && !trip;
}

bool add_guarded_moves(const Plant& plant, Timeline& timeline, const calib::JointVector& start,
                       const std::vector<calib::JointVector>& waypoints, double speed_m_s) {
  const calib::JointVector* from = &start;
  for (const calib::JointVector& to : waypoints) {
    if (!add_guarded_move(plant, timeline, cs8::Phase::kTravel, *from, to, speed_m_s)) return false;
    from = &to;
  }
  return true;
}

void add_retract(const Plant& plant, Timeline& timeline, const std::vector<Stretch>& way_out,
                 double speed_m_s) {
  for (const Stretch& stretch : way_out) {
    timeline.legs.push_back(timed_leg(plant, cs8::Phase::kRetract, stretch, speed_m_s));
  }
}

/// The search from the approach posture, and what follows from what it meets.
void add_search(const Plant& plant, Timeline& timeline, const TouchMotion& motion, double noise_m) {
  const StraightLine line = straight_line(plant, motion.approach, motion.search_end);
  const auto trip = find_trip(plant, line.path, noise_m);
  const double stop_m = stopping_distance_m(motion.search_speed_m_s, plant.stop_latency_s);
  const double end = trip ? std::min(1.0, *trip + stop_m / line.length_m) : 1.0;
  // Behind the trip the stylus yields, so nothing is hit there.
  const auto hit = find_hit(plant, line.path, trip.value_or(1.0));
  const double before_search_s = timeline.duration_s();

  timeline.legs.push_back(timed_leg(plant, cs8::Phase::kSearch, {line.path, 0.0, hit ? hit->progress : end},
                                    motion.search_speed_m_s));
  const Leg& search = timeline.legs.back();
  if (trip && !hit) {
    Capture capture{posture(line.path, *trip), search.stretch.at(1.0), 0.0, before_search_s};
    capture.overtravel_m = tip_distance_m(plant, capture.contact, capture.stopped);
    capture.at_s += search.duration_s * *trip / end;
    timeline.capture = capture;
  }
  if (hit) {
    end_in_collision(timeline, hit->clash);
    return;
  }
  const std::vector<Stretch> back = way_out_from(timeline.legs, timeline.legs.size() - 1, 1.0);
  if (!trip && !line.complete) {
    end_early(timeline, cs8::Outcome::kMotionError);
    timeline.error_number = kImpossibleMoveError;
    timeline.way_out = back;
    return;
  }
  timeline.outcome = trip ? cs8::Outcome::kContact : cs8::Outcome::kNoContact;
  if (trip && timeline.capture->overtravel_m > plant.overtravel_m)
    timeline.outcome = cs8::Outcome::kOvertravel;
  add_retract(plant, timeline, back, motion.approach_speed_m_s);
}

}  // namespace

double Timeline::duration_s() const {
  double sum = 0.0;
  for (const Leg& leg : legs) sum += leg.duration_s;
  return sum;
}

Place place_at(const Timeline& timeline, double time_s, const calib::JointVector& start) {
  if (timeline.legs.empty()) return {0, 1.0, cs8::Phase::kIdle, start};
  std::size_t index = 0;
  while (index + 1 < timeline.legs.size() && time_s >= timeline.legs[index].duration_s) {
    time_s -= timeline.legs[index].duration_s;
    ++index;
  }
  const Leg& leg = timeline.legs[index];
  const double share = time_s >= leg.duration_s ? 1.0 : std::max(0.0, time_s / leg.duration_s);
  return {index, share, leg.phase, leg.stretch.at(share)};
}

std::vector<Stretch> way_out_from(const std::vector<Leg>& legs, std::size_t leg, double share) {
  std::vector<Stretch> way;
  const Stretch& here = legs[leg].stretch;
  if (legs[leg].phase == cs8::Phase::kRetract) {
    way.push_back({here.path, here.progress(share), here.to});
    for (std::size_t next = leg + 1; next < legs.size(); ++next) way.push_back(legs[next].stretch);
  } else if (legs[leg].phase != cs8::Phase::kTravel) {
    way.push_back({here.path, here.progress(share), here.from});
    while (leg-- > 0 && legs[leg].phase == cs8::Phase::kApproach) {
      way.push_back({legs[leg].stretch.path, legs[leg].stretch.to, legs[leg].stretch.from});
    }
  }
  return way;
}

Timeline touch_timeline(const Plant& plant, const calib::JointVector& start, const TouchMotion& motion,
                        double noise_m) {
  Timeline timeline;
  if (add_guarded_moves(plant, timeline, start, motion.waypoints, motion.travel_speed_m_s) &&
      add_guarded_move(plant, timeline, cs8::Phase::kApproach, motion.waypoints.back(), motion.approach,
                       motion.approach_speed_m_s)) {
    add_search(plant, timeline, motion, noise_m);
  }
  return timeline;
}

Timeline travel_timeline(const Plant& plant, const calib::JointVector& start,
                         const std::vector<calib::JointVector>& waypoints, double speed_m_s) {
  Timeline timeline;
  add_guarded_moves(plant, timeline, start, waypoints, speed_m_s);
  return timeline;
}

Timeline retract_timeline(const Plant& plant, const std::vector<Stretch>& way_out, double speed_m_s) {
  Timeline timeline;
  add_retract(plant, timeline, way_out, speed_m_s);
  return timeline;
}

}  // namespace sim
