#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "calib_core/estimation/pure_error.hpp"
#include "service/run/block_pose.hpp"
#include "service/run/block_temperature.hpp"

namespace cell {

/// Who makes the touches of a run: the controller, or a person with the pendant.
enum class TouchMode { kAutomatic, kGuided };
std::string_view touch_mode_name(TouchMode touching);  // "automatic", "guided"

/// A longer time of moving than this says no more of how warm the arm is.
inline constexpr double kArmMovingMaxMin = 1440.0;

/// What the newest qualification of the probe measured of the noise of a touch.
struct QualifiedNoise {
  std::int64_t run = 0;  // the qualification
  calib::TouchNoise noise;
};

/// Its standard deviation in micrometres to six decimals: the same number however often it is written and
/// read.
double scatter_um_of(const calib::TouchNoise& noise);

/// What a result depends on besides its touches; stored with every run. Absent means unknown.
struct RunConditions {
  std::optional<std::string> operator_name;
  std::optional<std::string> config_digest;           // configuration_digest() at the daemon's start
  std::optional<std::string> controller_application;  // name and version, as reported
  std::optional<std::uint32_t> controller_session;    // distinguishes starts of the controller
  std::optional<TouchMode> touch_mode;
  TemperatureSource temperature_source = TemperatureSource::kFile;
  std::optional<double> arm_moving_min;     // minutes at working speed before the run: how warm the arm was
  std::optional<BlockPose> place;           // as located; absent if the block stands where its file says
  std::optional<QualifiedNoise> qualified;  // of a calibration; absent: none that counts
  std::optional<std::string> tool;          // of RunKind::kTool: which
};

}  // namespace cell
