#pragma once

#include <string>
#include <vector>

#include "service/documents/result_document.hpp"
#include "service/documents/run_document.hpp"
#include "service/documents/status_document.hpp"

namespace cell {

/// A result document (touchcal/result/1) as text: the errors, rank and condition numbers, the distances of
/// each plane before and after, the figures beside their limits, the verdict with its reasons.
std::string result_text(const ResultDocument& result);

/// The status document in a few lines.
std::string status_text(const StatusDocument& status);

/// The run waits for a person to bring the block to another place: told as a fault, and a step of the work.
bool is_block_to_move(const StatusDocument& status);

/// The benefit of further touches in a status document: a line, or nothing.
std::string more_text(const StatusDocument& status);

/// The history as a table, newest first.
std::string runs_text(const std::vector<RunSummary>& runs);

}  // namespace cell
