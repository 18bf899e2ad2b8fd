#pragma once

#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>

/// How figures and texts look in every document.
namespace cell {

using Json = nlohmann::ordered_json;

/// A figure that is not there, or is no number, is null: never 0, never NaN.
Json number(std::optional<double> value);

/// The same in millimetres.
Json number_mm(std::optional<double> value_m);

/// Text from outside (a robot's message, an operator's key) may be no UTF-8: it is shown as far as it is.
std::string text_of(const Json& document);

}  // namespace cell
