#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

/// The structures of VAL3, in degrees and in the application's unit of length.
namespace val3 {

using Joint = std::array<double, 6>;    // deg
using JointRs = std::array<double, 4>;  // deg, mm

/// Turned about x, then the new y, then the new z: R = Rx Ry Rz (manual 6, page 114).
struct Trsf {
  double x = 0.0, y = 0.0, z = 0.0;     // mm or inch
  double rx = 0.0, ry = 0.0, rz = 0.0;  // deg
  bool operator==(const Trsf&) const = default;
};

enum class Shoulder : std::uint8_t { kRighty, kLefty, kSame, kFree };
enum class Elbow : std::uint8_t { kPositive, kNegative, kSame, kFree };
enum class Wrist : std::uint8_t { kPositive, kNegative, kSame, kFree };
enum class Blend : std::uint8_t { kOff, kJoint, kCartesian };

struct Config {
  Shoulder shoulder = Shoulder::kSame;
  Elbow elbow = Elbow::kSame;
  Wrist wrist = Wrist::kSame;
  bool operator==(const Config&) const = default;
};

/// Which variable a point, frame or tool is given in: an element of an array of frames or tools that the
/// machine numbers.
struct Father {
  int array = -1;  // -1: none (error 162 to 164 when it is used)
  std::size_t element = 0;
  bool operator==(const Father&) const = default;
};
inline constexpr int kWorldArray = 0;
inline constexpr int kFlangeArray = 1;

struct Point {
  Trsf trsf;
  Config config;
  Father father;
  bool operator==(const Point&) const = default;
};
struct Frame {
  Trsf trsf;
  Father father{kWorldArray, 0};
  bool operator==(const Frame&) const = default;
};

/// A digital, analogue or serial link: a number that the system gave, or nothing.
struct Link {
  int id = -1;
  bool operator==(const Link&) const = default;
};
struct Dio : Link {};
struct Aio : Link {};
struct Sio : Link {};

struct Tool {
  Trsf trsf;
  Father father{kFlangeArray, 0};
  Dio gripper;
  double open_s = 0.0, close_s = 0.0;
  bool operator==(const Tool& other) const { return trsf == other.trsf && father == other.father; }
};

/// Defaults as s7's data files have them.
struct Mdesc {
  double accel = 100.0, vel = 100.0, decel = 100.0;  // % of nominal
  double tvel = 99999.0, rvel = 99999.0;             // of the tool centre: mm/s or inch/s, deg/s
  Blend blend = Blend::kJoint;
  double leave = 50.0, reach = 50.0;  // mm or inch
  bool operator==(const Mdesc&) const = default;
};

}  // namespace val3
