#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "service/offline_programs/xml_text.hpp"

namespace cell {

using SixNumbers = std::array<double, 6>;
using SixNames = std::array<std::string_view, 6>;

/// Of a trsf, and of what holds one: points, frames, tools.
inline constexpr SixNames kTrsfNames{"x", "y", "z", "rx", "ry", "rz"};
inline constexpr SixNames kJointNames{"j1", "j2", "j3", "j4", "j5", "j6"};

/// A number larger than this is no place of an arm's: units or degrees.
inline constexpr double kStoredNumberMax = 1e5;
/// What is written has at most so many: 0.000001 deg is 17 nm at one metre.
inline constexpr int kStoredDecimals = 6;

/// A number of an element's attribute: where it stands in the file, or where it would.
struct NumberPlace {
  double value = 0.0;       // 0 where it was left out (VAL3 language reference, 1.4)
  bool is_written = false;  // else [begin, begin) is where the attribute belongs
  std::size_t begin = 0;
  std::size_t end = 0;
};
using NumberPlaces = std::array<NumberPlace, 6>;

/// The six numbers of an element. One that was left out belongs behind the one before it; where none of those
/// is written, behind the key or the index, else behind the element's name. Throws ConfigError with the line:
/// a number that is none or is too large, an attribute that is there twice.
NumberPlaces number_places(const XmlText& xml, pugi::xml_node element, const SixNames& names);
SixNumbers numbers_of(const NumberPlaces& places);

/// At most so many decimals, no trailing zeros, no "-0". Throws std::logic_error unless it is finite.
std::string stored_number(double value, int decimals = kStoredDecimals);

/// What stands in a file from `begin` to `end` is replaced.
struct TextEdit {
  std::size_t begin = 0;
  std::size_t end = 0;
  std::string text;
};
/// Edits must not overlap; those at one place keep their order.
std::string edited(std::string_view text, std::vector<TextEdit> edits);

/// Appends what makes the element hold these numbers, and nothing where the six decimals are the same.
/// Returns the names of the attributes that are inserted because they were left out.
std::vector<std::string> append_edits(const XmlText& xml, const NumberPlaces& places, const SixNames& names,
                                      const SixNumbers& numbers, std::vector<TextEdit>& edits);

}  // namespace cell
