#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "calib_core/estimation/repeat_sources.hpp"
#include "calib_core/geometry/touch.hpp"
#include "config/cell.hpp"

namespace cell {

inline constexpr std::string_view kTouchesSchema = "touchcal/touches/4";
inline constexpr std::string_view kFirstTouchesSchema = "touchcal/touches/1";  // no touch has a noise_um
inline constexpr std::string_view kSecondTouchesSchema =
    "touchcal/touches/2";                                                      // no times, no second contacts
inline constexpr std::string_view kThirdTouchesSchema = "touchcal/touches/3";  // no qualification
inline constexpr std::string_view kTouchesCsvHeader = "plane,j1_deg,j2_deg,j3_deg,j4_deg,j5_deg,j6_deg";
inline constexpr std::size_t kTouchCountMax = 100'000;
/// Room for kTouchCountMax touches with every number on a line of its own.
inline constexpr std::size_t kTouchesSizeMax = 64U << 20U;

struct TouchesFile {
  std::vector<calib::Touch> touches;
  calib::Repeats repeats;  // the reference touches are of one spot in one posture, at each place of the block
  /// A sentence a touch with joints outside their ranges; touches count from 1. And what makes reference
  /// touches say nothing: too few, or copies of each other.
  std::vector<std::string> warnings;
};

/// JSON, or CSV when the file's name ends in .csv or its first line is kTouchesCsvHeader. ConfigError: what
/// is not as config/FILES.md says, another arm's touches, a plane the block does not have, reference touches
/// of more than one place or whose times run backwards, a first contact or a repetition of another place; a
/// CSV error names its line.
/// `recipe`: the planes of its places are numbered on (config/touched_places.hpp).
TouchesFile read_touches(const std::filesystem::path& file, const Cell& cell, const Recipe& recipe = {});

/// The same from memory. `source` is how messages call the bytes.
TouchesFile touches_from_json(const std::string& source, std::string_view bytes, std::size_t size_max_bytes,
                              const Cell& cell, const Recipe& recipe = {});
TouchesFile touches_from_csv(const std::string& source, std::string_view bytes, const Cell& cell,
                             const Recipe& recipe = {});

}  // namespace cell
