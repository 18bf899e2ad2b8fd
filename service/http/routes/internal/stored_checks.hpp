#pragma once

#include <chrono>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "config/cell.hpp"
#include "service/documents/checks_view.hpp"
#include "service/run/cell_figures.hpp"
#include "service/store/run_store.hpp"

namespace cell {

/// The checks of a calibration that came to their end, oldest first. One whose result cannot be read has no
/// verdict. Throws what the store throws.
std::vector<EndedCheck> checks_of(const RunStore& store, std::int64_t calibration);

/// Those of them that had ended when this one, of the same calibration, did: later ones change nothing of its
/// report. All of them while it has not ended.
std::vector<EndedCheck> checks_until(const RunStore& store, std::int64_t calibration, const StoredRun& check);

struct FoundFigures {
  CellFigures figures;
  std::optional<std::string> trouble;  // why some are unknown that are stored; nothing: all was read
};

/// The figures of what is stored, those of the checks from the same charts as GET /api/v1/checks. Throws
/// nothing of the store: what cannot be read is unknown.
FoundFigures cell_figures(const RunStore& store, const Cell& cell, std::chrono::system_clock::time_point now);

}  // namespace cell
