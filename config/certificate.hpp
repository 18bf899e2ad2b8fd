#pragma once

#include <cstddef>
#include <optional>

#include "config/cell.hpp"

namespace cell {

/// All that a block's file says of offsets and lengths is true together less often than this by chance: a
/// slip of the pen, then.
inline constexpr double kCertificateChanceMin = 1e-3;

/// The length that fits the other statements of its block worst.
struct ContradictedLength {
  std::size_t length = 0;   // index into Block::lengths
  double off_m = 0.0;       // from what all the others give
  double chi_square = 0.0;  // of all of them together
  int degrees = 0;          // its degrees of freedom
};

/// Chi-square test of the lengths and of the offsets of known faces together, each with its own deviation: it
/// sees what no pair shows, lengths around a closed loop for one. An estimated face may lie anywhere. Nothing
/// when chance makes as much in at least kCertificateChanceMin of all certificates.
std::optional<ContradictedLength> find_contradicted_length(const Block& block);

}  // namespace cell
