#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "config/cell.hpp"
#include "config/json_value.hpp"

namespace cell {

inline constexpr std::string_view kArmSchema = "touchcal/arm/5";
inline constexpr std::string_view kFourthArmSchema = "touchcal/arm/4";  // without a serial number
inline constexpr std::string_view kThirdArmSchema = "touchcal/arm/3";   // without the uncertainty
inline constexpr std::string_view kSecondArmSchema = "touchcal/arm/2";  // without the periods of ripple
inline constexpr std::string_view kFirstArmSchema = "touchcal/arm/1";   // without gears and std_mass_share

/// Joint ranges, speeds, frames, bodies of an arm. ConfigError.
Arm read_arm(const std::filesystem::path& file);
/// The same of a document's text; messages call it `source`.
Arm read_arm_text(const std::string& source, std::string_view text);

/// The entry of "frames" for `frame` into the arm: its parameters and standard deviations replace what was
/// there.
void read_frame(const JsonValue& value, int frame, Arm& arm);

/// The "j" of an entry of "frames".
int frame_number(const JsonValue& value);

}  // namespace cell
