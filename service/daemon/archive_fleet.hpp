#pragma once

#include "service/base/clocks.hpp"
#include "service/http/routes/services.hpp"

namespace cell {

struct DaemonOptions;

/// All cells of the archive that is configured, as its user may see them; empty where none is.
FleetView archive_fleet(const DaemonOptions& options, const Clocks& clocks);

}  // namespace cell
