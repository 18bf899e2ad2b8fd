#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "config/cell.hpp"
#include "service/documents/status_document.hpp"
#include "service/run/status.hpp"
#include "service/store/run_page.hpp"

/// Documents of status, runs and touches. Field names of the API and of files are defined in
/// service/documents only. Every function returns one JSON document as text.
namespace cell {

/// Name of a touch's role in every document.
StatusDocument status_of(const Status& status);
LiveFields live_fields(std::optional<std::int64_t> data_age_ms, const std::vector<SinkState>& sinks);
std::string status_document(const Status& status);

std::string run_document(const StoredRun& run);

/// A page of the history.
std::string runs_document(const RunPage& page);

/// What `touchcal identify` reads back: touchcal/touches/1, /2 where a touch has a noise of its own, /3 where
/// times, first contacts or repetitions are known.
/// `references`: of the same run; `recipe`: its own, null where the cell has it no more.
std::string touches_document(const Cell& cell, const std::vector<StoredTouch>& touches,
                             const std::vector<ReferenceTouch>& references,
                             const std::optional<calib::TouchNoise>& qualified = {},
                             const Recipe* recipe = nullptr);

}  // namespace cell
