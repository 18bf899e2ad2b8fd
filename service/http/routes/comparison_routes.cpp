#include <spdlog/fmt/fmt.h>

#include <tuple>

#include "service/acquisition/past_calibration.hpp"
#include "service/documents/comparison_view.hpp"
#include "service/http/routes/route_table.hpp"

namespace cell {
namespace {

std::variant<calib::CalibrationRecord, VerificationRefusal> stored_record(const Reads& reads,
                                                                          std::int64_t run) {
  auto past = find_calibration(reads.store(), RunKind::kProof, run, reads.config_digest());
  if (auto* refusal = std::get_if<VerificationRefusal>(&past)) return *refusal;
  const auto& place = reads.place();
  return record_of(std::get<PastCalibration>(past), reads.cell(),
                   place ? place->cell_from_block : Eigen::Isometry3d::Identity());
}

HttpResponse not_comparable(const std::string& why) {
  return to_response({.status = 409, .kind = ProblemKind::kNoResult, .detail = why});
}

HttpResponse comparison_of(const Reads& reads, std::int64_t earlier, std::int64_t later) {
  const auto first = stored_record(reads, earlier), second = stored_record(reads, later);
  for (const auto* record : {&first, &second})
    if (const auto* refusal = std::get_if<VerificationRefusal>(record))
      return not_comparable(refusal->message);
  const auto outcome =
      calib::compare(std::get<calib::CalibrationRecord>(first), std::get<calib::CalibrationRecord>(second));
  if (const auto* refusal = std::get_if<calib::ComparisonRefusal>(&outcome))
    return not_comparable(refusal->message);
  return json_response(200,
                       document_text(comparison_view(earlier, later, std::get<calib::Comparison>(outcome),
                                                     reads.tip_regions().tip().workspace_box)));
}

/// By their dates: a run that was imported has a number of this daemon.
bool is_earlier(const StoredRun& one, const StoredRun& other) {
  return std::tie(one.started_at, one.id) < std::tie(other.started_at, other.id);
}

HttpResponse get_comparison(const Call& call) {
  const auto id = call.run_id();
  const auto run = id ? call.reads.store().run(*id) : std::nullopt;
  if (!run) return not_found("there is no run '" + std::string(call.id) + "'; GET /api/v1/runs lists them");
  const auto other = call.number("with");
  if (!other || *other == run->id)
    return to_response({.status = 400,
                        .kind = ProblemKind::kQuery,
                        .detail = "with which run? Give with=RUN, the number of another calibration",
                        .parameter = "with"});
  const auto other_run = call.reads.store().run(*other);
  if (!other_run) return not_found(fmt::format("there is no run {}; GET /api/v1/runs lists them", *other));
  const bool is_second = is_earlier(*other_run, *run);
  return comparison_of(call.reads, is_second ? *other : run->id, is_second ? run->id : *other);
}

}  // namespace

std::vector<Route> comparison_routes() {
  return {
      {.method = "GET",
       .path = "/api/v1/runs/{id}/comparison",
       .summary =
           "Whether the arm has changed between two accepted calibrations, by the combinations of errors "
           "that both identified; takes a fraction of a second",
       .handle = get_comparison,
       .answers = {{.schema = "Comparison"}},
       .query = {{"with", 1, std::int64_t{1} << 53, "the number of the other run"}},
       .dispatch = DispatchMode::kWorker},
  };
}

}  // namespace cell
