#include <stdexcept>

#include "service/http/routes/route_table.hpp"
#include "service/http/routes/services.hpp"

namespace cell {
namespace {

constexpr int kMonthsTold = 12;
constexpr int kMonthsToldMax = 240;
/// An archive that was away is asked again after so long.
constexpr int kArchiveRetrySeconds = 15;

HttpResponse without_archive() {
  return to_response(
      {.status = 409,
       .kind = ProblemKind::kNoArchive,
       .detail =
           "no archive is configured; touchcald --archive URL tells it the cell's facts and shows those "
           "of all cells that the cell's user of it may read"});
}

/// What the archive says; 503 where it is away.
template <class Ask>
HttpResponse told_by_archive(const Ask& ask) try {
  return json_response(200, ask());
} catch (const std::runtime_error& error) {
  return to_response({.status = 503,
                      .kind = ProblemKind::kArchiveAway,
                      .detail = error.what(),
                      .retry_after_s = kArchiveRetrySeconds});
}

HttpResponse get_fleet(const Call& call) {
  const FleetView& fleet = call.services.fleet;
  if (!fleet.cells) return without_archive();
  return told_by_archive([&] { return fleet.cells(); });
}

HttpResponse get_fleet_trends(const Call& call) {
  const FleetView& fleet = call.services.fleet;
  if (!fleet.trends) return without_archive();
  const int months = static_cast<int>(call.number("months").value_or(kMonthsTold));
  return told_by_archive([&] { return fleet.trends(months); });
}

}  // namespace

std::vector<Route> fleet_routes() {
  return {
      {.method = "GET",
       .path = "/api/v1/fleet",
       .summary = "All cells of the plant's archive that this cell may read, and what each told last; 409 "
                  "without an archive, 503 where it is away",
       .handle = get_fleet,
       .answers = {{.schema = "Fleet"}},
       .dispatch = DispatchMode::kArchive},
      {.method = "GET",
       .path = "/api/v1/fleet/trends",
       .summary = "The same cells by the type of their arm and by month, the newest first",
       .handle = get_fleet_trends,
       .answers = {{.schema = "FleetTrends"}},
       .query = {{"months", 1, kMonthsToldMax, "this month and those before it; 12 without it"}},
       .dispatch = DispatchMode::kArchive},
  };
}

}  // namespace cell
