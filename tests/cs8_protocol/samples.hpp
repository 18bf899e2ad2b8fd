#pragma once

#include <cstring>
#include <vector>

#include "cs8_protocol/codec.hpp"

/// One message of every type with a different value in every field, for tests.
namespace cs8 {

inline JointsMicrodeg joints_from(std::int32_t first) {
  return {first, -first - 1, first + 2, -first - 3, first + 4, -first - 5};
}

inline std::vector<Message> one_of_each() {
  Touch touch{.via_count = 2,
              .clear = joints_from(60),
              .approach = joints_from(70),
              .search_end = joints_from(80),
              .travel_speed_um_s = 250000,
              .approach_speed_um_s = 20000,
              .search_speed_um_s = 8000,
              .second_speed_um_s = 2000,
              .second_backoff_dmm = 20000,
              .deadline_ms = 120000};
  Travel travel{
      .via_count = 5, .target = joints_from(600), .travel_speed_um_s = 250001, .deadline_ms = 4000000000u};
  for (std::size_t i = 0; i < kViaCountMax; ++i) {
    touch.via[i] = joints_from(10 + static_cast<std::int32_t>(i) * 10);
    travel.via[i] = joints_from(100 + static_cast<std::int32_t>(i) * 100);
  }
  const Welcome welcome{.application = text16("touchcal"),
                        .arm = text16("sixteen letters!"),
                        .application_version = 10203,
                        .language_version = 70702,
                        .session = 7,
                        .last_sequence = 41,
                        .open_sequence = 42,
                        .heartbeat_timeout_ms = 500,
                        .clock_ms = 4294967295u,
                        .lower_limits = joints_from(-180000000),
                        .upper_limits = joints_from(180000000),
                        .search_length_max_dmm = 400000,
                        .search_speed_max_um_s = 20000};
  const State state{.session = 7,
                    .clock_ms = 123456,
                    .flags = kPowered | kProbeTouched,
                    .mode = WorkingMode::kRemote,
                    .mode_status = 2,
                    .emergency_stop = 1,
                    .monitor_speed_percent = 100,
                    .joints = joints_from(-5),
                    .active_sequence = 9,
                    .phase = Phase::kSearch,
                    .task_error = 150,
                    .permit = PermitState::kRetractOnly,
                    .move_id_milli = 3500,
                    .overruns = 77};
  const TouchResult touch_result{.outcome = Outcome::kContact,
                                 .phase = Phase::kRetract,
                                 .source = CaptureSource::kPolled,
                                 .contact = joints_from(1000),
                                 .stopped = joints_from(2000),
                                 .overtravel_dmm = 1280,
                                 .search_speed_um_s = 8000,
                                 .monitor_speed_percent = 99,
                                 .contact_clock_ms = 654321,
                                 .error_number = -1,
                                 .first_source = CaptureSource::kLatched,
                                 .first_contact = joints_from(4000),
                                 .edges = 3};
  const MoveResult move_result{.outcome = Outcome::kMotionError,
                               .phase = Phase::kTravel,
                               .joints = joints_from(3000),
                               .error_number = 154};
  return {{0, Hello{500}},
          {0, Heartbeat{0x01020304}},
          {1, touch},
          {2, travel},
          {3, Retract{20000, 30000}},
          {0, Stop{}},
          {0, ResultQuery{4}},
          {0, ResultAcknowledge{5}},
          {0, Begin{31, 30000}},
          {0, Finish{}},
          {0, welcome},
          {4294967295u, state},
          {6, Accepted{}},
          {7, Rejected{RejectReason::kOutOfRange, 6}},
          {8, touch_result},
          {9, move_result},
          {10, ResultUnknown{10}},
          {0, Fault{FaultCode::kLength, 12}},
          {0, Permit{31, PermitState::kNone, PermitReason::kRefused, 20}}};
}

/// Messages are words without padding (codec.cpp holds that), so their memory tells whether they are the
/// same.
inline bool same(const Message& a, const Message& b) {
  if (a.sequence != b.sequence || a.payload.index() != b.payload.index()) return false;
  return std::visit(
      [&]<class Body>(const Body& body) {
        return std::is_empty_v<Body> || std::memcmp(&body, &std::get<Body>(b.payload), sizeof(Body)) == 0;
      },
      a.payload);
}

/// Header and payload of one whole frame.
inline DecodeResult decode_frame(std::span<const std::uint8_t> frame) {
  const auto header = decode_header(frame.first<kHeaderSize>());
  if (const auto* error = std::get_if<DecodeError>(&header)) return *error;
  return decode(std::get<Header>(header), frame.subspan(kHeaderSize));
}

}  // namespace cs8
