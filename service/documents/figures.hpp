#pragma once

#include <optional>

namespace cell {

/// A figure of a document: no value where there is none or it is no number, as NaN and infinity.
std::optional<double> finite(std::optional<double> value);

/// The same in millimetres.
std::optional<double> finite_mm(std::optional<double> value_m);

}  // namespace cell
