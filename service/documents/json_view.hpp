#pragma once

#include <optional>
#include <string>
#include <vector>

#include "config/cell.hpp"
#include "service/documents/status_document.hpp"
#include "service/run/status.hpp"
#include "service/store/run_store.hpp"

/// The API's and the files' field names, here, in parameter_view, result_view and validation_view, and
/// nowhere else. Every function returns one JSON document as text.
namespace cell {

/// How a touch's role is called in every document.
const char* role_name(calib::TouchRole role);

StatusDocument status_of(const Status& status);
std::string status_document(const Status& status);

std::string run_document(const StoredRun& run);

/// A page of the history; `next_before` is the id to ask for the page after it, nothing on the last.
std::string runs_document(const std::vector<StoredRun>& runs, std::optional<std::int64_t> next_before);

/// touchcal/touches/1: what `touchcal identify` reads back.
std::string touches_document(const Cell& cell, const std::vector<StoredTouch>& touches);

}  // namespace cell
