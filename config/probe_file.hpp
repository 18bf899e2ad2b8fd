#pragma once

#include <filesystem>
#include <string_view>

#include "config/cell.hpp"

namespace cell {

inline constexpr std::string_view kProbeSchema = "touchcal/probe/4";
inline constexpr std::string_view kThirdProbeSchema = "touchcal/probe/3";   // without tips
inline constexpr std::string_view kSecondProbeSchema = "touchcal/probe/2";  // without serial
inline constexpr std::string_view kFirstProbeSchema = "touchcal/probe/1";   // one pre-travel for all pushes

/// The probe and its stylus. A ball radius or a pre-travel that is not there is refused: unknown is not zero;
/// "tip_is_contact_point":true says that there is no ball, and then neither may be given. From the second
/// schema on the pre-travel may depend on the direction of the push: calib::SidewaysPretravel; from the
/// fourth on there may be further tips. ConfigError.
Probe read_probe(const std::filesystem::path& file);

}  // namespace cell
