#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

namespace cell {

/// A result document (touchcal/result/1) as text: the errors, rank and condition numbers, the distances of
/// each plane before and after, the verdict with its reasons.
std::string result_text(const nlohmann::json& result);

/// The status document in a few lines.
std::string status_text(const nlohmann::json& status);

/// The benefit of further touches in a status document: a line, or nothing.
std::string more_text(const nlohmann::json& status);

/// The history as a table, newest first.
std::string runs_text(const nlohmann::json& runs);

}  // namespace cell
