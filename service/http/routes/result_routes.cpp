#include "service/http/routes/internal/result_routes.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <cmath>

#include "config/config_error.hpp"
#include "config/identification_problem.hpp"
#include "service/acquisition/cell_operation.hpp"
#include "service/documents/parameter_view.hpp"
#include "service/documents/result_view.hpp"
#include "service/http/server/problem.hpp"
#include "service/report/report_document.hpp"
#include "service/report/report_html.hpp"
#include "service/run/block_temperature.hpp"
#include "service/run/calibrated_arm.hpp"
#include "service/run/reference_drift.hpp"
#include "service/run/run_recipe.hpp"
#include "service/store/fault_log.hpp"

namespace cell {
namespace {

/// In mm and rad: a larger difference of a nominal parameter means another arm.
constexpr double kSameNominal = 1e-9;

struct Identified {
  Recipe recipe;
  calib::IdentificationProblem problem;
  calib::IdentificationResult result;
};

HttpResponse conflict(const std::string& detail) {
  return to_response({.status = 409, .kind = ProblemKind::kNoResult, .detail = detail});
}

/// Identifies the stored touches of a run again: the same result, bit by bit, while the cell is the same.
std::variant<Identified, HttpResponse> identify_stored(const CellOperation& operation, std::int64_t id) try {
  const StoredRun run = operation.store().run(id).value();
  const Cell cell = with_block_temperature(operation.cell(), temperature_of(run, operation.cell()));
  if (!operation.cell().recipes.contains(run.recipe))
    return conflict("there is no result: this cell no longer has the run's recipe");
  const std::vector<StoredTouch> touches = operation.store().touches(id);
  if (touches.empty()) return conflict("there is no result: no touch has been made yet");
  Identified identified{recipe_of(run, cell), {}, {}};
  identified.problem = identification_problem(cell, identified.recipe);
  std::ranges::transform(touches, std::back_inserter(identified.problem.touches), to_touch);
  note_references(to_touches(operation.store().references(id), touches), identified.problem);
  identified.result = calib::identify(identified.problem, identified.recipe.identification);
  if (identified.result.status == calib::IdentificationStatus::kConverged) return identified;
  return conflict("there is no result: " + identified.result.message);
} catch (const ConfigError& error) {
  return conflict(std::string("there is no result: ") + error.what());
}

bool has_this_nominal(const std::string& result_json, const calib::KinematicModel& model) {
  const std::vector<Parameter> parameters = read_result(result_json).parameters;
  for (int i = 0; i < calib::kErrorParameterCount; ++i) {
    const double then = parameters.at(static_cast<std::size_t>(i)).nominal.value();
    if (!(std::abs(then - shown(i, calib::parameter_value(model, i))) <= kSameNominal)) return false;
  }
  return true;
}

std::optional<std::string> known_document(const CellOperation& operation, std::int64_t id) {
  if (auto stored = operation.store().result_json(id)) return stored;  // the run is over
  const Run* live = operation.run();
  return live && live->id() == id ? operation.result_json() : std::nullopt;
}

RunRecord record_of(const CellOperation& operation, const StoredRun& run) {
  const RunStore& store = operation.store();
  RunRecord record{.run = run,
                   .touches = store.touches(run.id),
                   .superseded = store.superseded_touches(run.id),
                   .references = store.references(run.id),
                   .faults = FaultLog(store.database()).page(FaultLog::kKept, {}, run.id),
                   .result_json = {}};
  HttpResponse result = get_result(operation, run.id);
  if (result.status == 200) record.result_json = std::move(result.body);
  return record;
}

/// Served as a download: the content security policy of the daemon allows no inline styles.
HttpResponse saved_as(std::string_view ending, std::string_view type, std::int64_t run, std::string body) {
  return {.content_type = std::string(type),
          .body = std::move(body),
          .headers = {{"Content-Disposition",
                       fmt::format("attachment; filename=\"touchcal-run-{}.{}\"", run, ending)}}};
}

}  // namespace

HttpResponse get_result(const CellOperation& operation, std::int64_t id) {
  if (auto document = known_document(operation, id)) return {.body = std::move(*document)};
  // A run that ended with the daemon has touches and no result: they are identified now.
  auto found = identify_stored(operation, id);
  if (auto* response = std::get_if<HttpResponse>(&found)) return std::move(*response);
  const Identified& identified = std::get<Identified>(found);
  const ResultContext context{.complete = false,
                              .warnings = {},
                              .conditions = operation.store().run(id)->conditions_json.value_or("")};
  return {.body = result_document(operation.tip_regions(), identified.recipe, identified.problem,
                                  identified.result, context)};
}

HttpResponse get_arm(const CellOperation& operation, std::int64_t id) {
  const auto document = known_document(operation, id);
  if (document && !has_this_nominal(*document, operation.cell().arm.model)) {
    return conflict(
        "the cell's nominal arm differs from that of this run; the result of the run holds the errors that "
        "were identified then");
  }
  auto found = identify_stored(operation, id);
  if (auto* response = std::get_if<HttpResponse>(&found)) return std::move(*response);
  return {.body = calibrated_arm_document(operation.cell(), std::get<Identified>(found).result)};
}

HttpResponse get_report(const CellOperation& operation, const StoredRun& run, const std::string& format) {
  if (format != "html" && format != "csv" && format != "json") {
    return to_response({.status = 400,
                        .kind = ProblemKind::kQuery,
                        .detail = "format is html, csv or json; touchcal report makes a PDF of the first",
                        .parameter = "format"});
  }
  // Once to text and back: replaces bytes from outside that are not UTF-8, for all formats.
  const std::string document = report_document(record_of(operation, run));
  if (format == "json") return {.body = document};
  const RunReport report = read_report(document);
  if (format == "html") return saved_as("html", kHtml, run.id, report_html(report));
  return saved_as("csv", kCsv, run.id, report_csv(report));
}

}  // namespace cell
