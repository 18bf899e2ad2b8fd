#pragma once

#include <span>

#include "service/documents/fleet_document.hpp"
#include "service/documents/run_document.hpp"

namespace cell {

/// The runs of a cell as its facts tell them: what the cell itself lists, newest first, without those that it
/// took in from another. `facts`: oldest first; those without a run are passed over. A run whose facts cannot
/// be read is among `damaged`. What an older daemon did not tell is no value: how it was touched, of which
/// calibration a qualification or a tool is.
RunsDocument archived_runs(std::span<const ArchivedFact> facts);

}  // namespace cell
