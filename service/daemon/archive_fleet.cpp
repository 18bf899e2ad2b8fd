#include "service/daemon/archive_fleet.hpp"

#include <memory>

#include "service/archive/cached_fleet.hpp"
#include "service/daemon/daemon.hpp"

namespace cell {

FleetView archive_fleet(const DaemonOptions& options, const Clocks& clocks) {
  if (!options.archive) return {};
  const auto fleet = std::make_shared<CachedFleet>(*options.archive, clocks.steady);
  return {.cells = [fleet] { return fleet->fleet(); },
          .trends = [fleet](int months) { return fleet->trends(months); }};
}

}  // namespace cell
