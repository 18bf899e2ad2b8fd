#pragma once

namespace calib {

/// What becomes of a target: corrected, corrected near a posture in which corrections turn joints far, or
/// left alone.
enum class CompensationStatus { kOk, kWarned, kRefused };

}  // namespace calib
