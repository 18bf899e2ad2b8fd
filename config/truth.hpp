#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "calib_core/error_parameters.hpp"

namespace cell {

inline constexpr std::string_view kTruthSchema = "touchcal/truth/1";

/// What the simulated arm hides: its true errors. The true model is calib::apply(arm.model, errors).
struct Truth {
  std::string name;
  calib::ErrorVector errors = calib::ErrorVector::Zero();  // metres and radians; those not in the file are 0
};

/// ConfigError.
Truth read_truth(const std::filesystem::path& file);

}  // namespace cell
