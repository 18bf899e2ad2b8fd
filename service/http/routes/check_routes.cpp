#include <spdlog/fmt/fmt.h>

#include "service/acquisition/past_calibration.hpp"
#include "service/documents/checks_view.hpp"
#include "service/http/routes/internal/stored_checks.hpp"
#include "service/http/routes/route_table.hpp"

namespace cell {
namespace {

constexpr std::int64_t kChecksTold = 200, kChecksToldMax = 1000;

HttpResponse get_checks(const Call& call) {
  const RunStore& store = call.reads.store();
  const auto counting = calibration_of_cell(store, RunKind::kCheck);
  const auto asked = call.number("of_run");
  const auto of_run = asked ? asked : counting;
  if (!of_run)
    return to_response(
        {.status = 409,
         .kind = ProblemKind::kNoResult,
         .detail = "there is no accepted calibration that checks could be of: touchcal run first"});
  const auto calibration = store.run(*of_run);
  if (!calibration || calibration->kind != RunKind::kCalibration)
    return not_found(fmt::format(
        "there is no calibration '{}'; GET /api/v1/runs lists the runs with their kind", *of_run));
  // A calibration that another one has replaced is checked no more.
  const auto every = of_run == counting ? call.reads.cell().check_every : std::nullopt;
  ChecksDocument document = checks_view(*calibration, checks_of(store, *of_run), call.reads.cell().arm.model,
                                        every, call.reads.now());
  keep_newest(document, static_cast<std::size_t>(call.number("limit").value_or(kChecksTold)));
  return json_response(200, document_text(document));
}

}  // namespace

std::vector<Route> check_routes() {
  constexpr std::int64_t kRunIdMax = std::int64_t{1} << 53;
  return {
      {.method = "GET",
       .path = "/api/v1/checks",
       .summary =
           "The checks of a calibration: what each found as charts with limits, and when the next one is due",
       .handle = get_checks,
       .answers = {{.schema = "Checks"}},
       .query = {{"of_run", 1, kRunIdMax, "the calibration; without it the one that a check would be of"},
                 {"limit", 1, kChecksToldMax, "how many of the newest checks are told; 200 without it"}},
       .dispatch = DispatchMode::kStored},
  };
}

}  // namespace cell
