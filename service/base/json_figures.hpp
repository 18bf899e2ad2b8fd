#pragma once

#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>

/// How figures and texts are written in every document.
namespace cell {

using Json = nlohmann::ordered_json;

/// An absent or non-finite figure is null: never 0, never NaN.
Json number(std::optional<double> value);

/// The same in millimetres.
Json number_mm(std::optional<double> value_m);

/// An absent value is null. For bool, the integers of documents, double and std::string.
template <class T>
Json value_or_null(const std::optional<T>& value);

/// The document as text. Bytes from outside (a robot's message, an operator's key) that are not UTF-8 are
/// replaced.
std::string text_of(const Json& document);

}  // namespace cell
