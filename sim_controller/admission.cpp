#include "sim_controller/admission.hpp"

#include <cmath>
#include <span>

#include "cs8_protocol/wire_units.hpp"
#include "sim_controller/motion.hpp"

namespace sim {
namespace {

using cs8::RejectReason;

// Payload words, from 1, as kBadField names them: via_count, the via postures, then what follows.
constexpr std::int32_t kViaCountWord = 1;
constexpr std::int32_t kJointWords = calib::kJointCount;
constexpr std::int32_t kAfterViaWord = 2 + kJointWords * static_cast<std::int32_t>(cs8::kViaCountMax);
constexpr std::int32_t kTouchSearchEndWord = kAfterViaWord + 2 * kJointWords;
constexpr std::int32_t kTouchSpeedsWord = kAfterViaWord + 3 * kJointWords;
constexpr std::int32_t kTouchDeadlineWord = kTouchSpeedsWord + 5;
constexpr std::int32_t kTravelSpeedWord = kAfterViaWord + kJointWords;

constexpr std::int32_t kTravelSpeedMaxUmS = 250'000;
constexpr std::int32_t kApproachSpeedMaxUmS = 20'000;
constexpr std::int32_t kBackoffMinDmm = 5'000;
constexpr std::int32_t kBackoffMaxDmm = 50'000;

/// Ends of a search nearer than this leave it no direction.
constexpr double kSearchLengthMinMetres = 1e-6;

std::optional<cs8::Rejected> bad_unless(bool good, std::int32_t word) {
  if (good) return std::nullopt;
  return cs8::Rejected{RejectReason::kBadField, word};
}

std::optional<cs8::Rejected> bad_via_count(std::int32_t count) {
  return bad_unless(count >= 0 && count <= static_cast<std::int32_t>(cs8::kViaCountMax), kViaCountWord);
}

std::optional<cs8::Rejected> bad_travel_speed(std::int32_t speed_um_s, std::int32_t word) {
  return bad_unless(speed_um_s > 0 && speed_um_s <= kTravelSpeedMaxUmS, word);
}

std::optional<cs8::Rejected> bad_approach_speed(std::int32_t speed_um_s, std::int32_t word) {
  return bad_unless(speed_um_s > 0 && speed_um_s <= kApproachSpeedMaxUmS, word);
}

std::optional<cs8::Rejected> bad_second_touch(const cs8::Touch& command) {
  const std::int32_t speed = command.second_speed_um_s;
  if (auto bad = bad_unless(speed >= 0 && speed <= command.search_speed_um_s, kTouchSpeedsWord + 3))
    return bad;
  const std::int32_t backoff = command.second_backoff_dmm;
  return bad_unless(speed == 0 || (backoff >= kBackoffMinDmm && backoff <= kBackoffMaxDmm),
                    kTouchSpeedsWord + 4);
}

/// In wire units, so that a posture exactly on its limit is in range.
std::optional<cs8::Rejected> out_of_range(const Plant& plant, std::span<const cs8::JointsMicrodeg> postures) {
  const cs8::JointsMicrodeg lower = wire_from_joints(plant.joint_ranges.lower);
  const cs8::JointsMicrodeg upper = wire_from_joints(plant.joint_ranges.upper);
  for (const cs8::JointsMicrodeg& joints : postures) {
    for (std::size_t i = 0; i < joints.size(); ++i) {
      if (joints[i] < lower[i] || joints[i] > upper[i]) {
        return cs8::Rejected{RejectReason::kOutOfRange, static_cast<std::int32_t>(i) + 1};
      }
    }
  }
  return std::nullopt;
}

std::optional<cs8::Rejected> bad_search(const Plant& plant, const cs8::Touch& command) {
  const double length_m =
      tip_distance_m(plant, joints_from_wire(command.approach), joints_from_wire(command.search_end));
  if (length_m > kSearchLengthMaxMetres) {
    return cs8::Rejected{RejectReason::kSearchTooLong, cs8::dmm_from_metres(kSearchLengthMaxMetres)};
  }
  const std::int32_t speed_max = search_speed_max_um_s(plant);
  if (command.search_speed_um_s > speed_max) return cs8::Rejected{RejectReason::kSearchTooFast, speed_max};
  return bad_unless(length_m >= kSearchLengthMinMetres, kTouchSearchEndWord);
}

template <class Command>
std::vector<cs8::JointsMicrodeg> used_via(const Command& command) {
  return {command.via.begin(), command.via.begin() + command.via_count};
}

std::vector<calib::JointVector> postures_from_wire(std::span<const cs8::JointsMicrodeg> postures) {
  std::vector<calib::JointVector> joints;
  for (const cs8::JointsMicrodeg& posture : postures) joints.push_back(joints_from_wire(posture));
  return joints;
}

}  // namespace

std::optional<cs8::Rejected> refusal(const Plant& plant, const cs8::Touch& command) {
  if (auto bad = bad_via_count(command.via_count)) return bad;
  if (auto bad = bad_travel_speed(command.travel_speed_um_s, kTouchSpeedsWord)) return bad;
  if (auto bad = bad_approach_speed(command.approach_speed_um_s, kTouchSpeedsWord + 1)) return bad;
  if (auto bad = bad_unless(command.search_speed_um_s > 0, kTouchSpeedsWord + 2)) return bad;
  if (auto bad = bad_second_touch(command)) return bad;
  if (auto bad = bad_unless(command.deadline_ms > 0, kTouchDeadlineWord)) return bad;
  auto postures = used_via(command);
  postures.insert(postures.end(), {command.clear, command.approach, command.search_end});
  if (auto bad = out_of_range(plant, postures)) return bad;
  return bad_search(plant, command);
}

std::optional<cs8::Rejected> refusal(const Plant& plant, const cs8::Travel& command) {
  if (auto bad = bad_via_count(command.via_count)) return bad;
  if (auto bad = bad_travel_speed(command.travel_speed_um_s, kTravelSpeedWord)) return bad;
  if (auto bad = bad_unless(command.deadline_ms > 0, kTravelSpeedWord + 1)) return bad;
  auto postures = used_via(command);
  postures.push_back(command.target);
  return out_of_range(plant, postures);
}

std::optional<cs8::Rejected> refusal(const Plant&, const cs8::Retract& command) {
  if (auto bad = bad_approach_speed(command.approach_speed_um_s, 1)) return bad;
  return bad_unless(command.deadline_ms > 0, 2);
}

std::int32_t search_speed_max_um_s(const Plant& plant) {
  return static_cast<std::int32_t>(std::floor(search_speed_max_m_s(plant.overtravel_m) * 1e6));
}

calib::JointVector joints_from_wire(const cs8::JointsMicrodeg& joints) {
  return cs8::joints_from_microdeg<calib::JointVector>(joints);
}

cs8::JointsMicrodeg wire_from_joints(const calib::JointVector& joints) {
  return cs8::microdeg_from_joints(joints);
}

TouchMotion touch_motion(const cs8::Touch& command) {
  auto waypoints = used_via(command);
  waypoints.push_back(command.clear);
  return {postures_from_wire(waypoints),
          joints_from_wire(command.approach),
          joints_from_wire(command.search_end),
          cs8::metres_per_second_from_um_s(command.travel_speed_um_s),
          cs8::metres_per_second_from_um_s(command.approach_speed_um_s),
          cs8::metres_per_second_from_um_s(command.search_speed_um_s)};
}

std::vector<calib::JointVector> travel_waypoints(const cs8::Travel& command) {
  auto waypoints = used_via(command);
  waypoints.push_back(command.target);
  return postures_from_wire(waypoints);
}

}  // namespace sim
