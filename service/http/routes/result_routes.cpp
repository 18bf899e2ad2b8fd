#include "service/http/routes/internal/result_routes.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "calib_core/geometry/units.hpp"
#include "config/config_error.hpp"
#include "config/identification_problem.hpp"
#include "config/touched_places.hpp"
#include "service/base/utc_time.hpp"
#include "service/documents/checks_view.hpp"
#include "service/documents/conditions_view.hpp"
#include "service/documents/parameter_view.hpp"
#include "service/documents/result_view.hpp"
#include "service/http/routes/internal/stored_checks.hpp"
#include "service/http/server/problem.hpp"
#include "service/report/report_document.hpp"
#include "service/report/report_html.hpp"
#include "service/report/verification_html.hpp"
#include "service/report/verification_report.hpp"
#include "service/report/words/words.hpp"
#include "service/run/block_temperature.hpp"
#include "service/run/calibrated_arm.hpp"
#include "service/run/run_recipe.hpp"
#include "service/run/run_repeats.hpp"
#include "service/run/simulated_calibrations.hpp"
#include "service/store/fault_log.hpp"

namespace cell {
namespace {

struct Identified {
  Recipe recipe;
  calib::IdentificationProblem problem;
  calib::IdentificationResult result;
};

HttpResponse conflict(const std::string& detail) {
  return to_response({.status = 409, .kind = ProblemKind::kNoResult, .detail = detail});
}

/// Why a run cannot be computed again from what this daemon was started with; nothing when it can.
std::optional<std::string> why_not_again(const Reads& reads, const StoredRun& run) {
  if (run.config_digest != reads.config_digest()) {
    return fmt::format(
        "the cell's files are not those of this run (their digest is {}, that of the run {}); start "
        "touchcald "
        "with the files that the run had",
        reads.config_digest().value_or("unknown"), run.config_digest.value_or("unknown"));
  }
  if (!stood_at(run.conditions_json, reads.place())) {
    return "the block is not located where it stood in this run; the conditions of the run name the place "
           "that it had";
  }
  return std::nullopt;
}

/// Identifies the stored touches of a run again: the same result, bit by bit. Refused where the cell is not
/// that of the run.
std::variant<Identified, HttpResponse> identify_stored(const Reads& reads, std::int64_t id) try {
  const StoredRun run = reads.store().run(id).value();
  if (run.kind != RunKind::kCalibration)
    return conflict(
        fmt::format("there is no result: the {} ended before it had one", run_kind_name(run.kind)));
  if (const auto why = why_not_again(reads, run))
    return conflict("it would have to be computed again, but " + *why);
  const Cell cell = with_block_temperature(reads.cell(), temperature_of(run, reads.cell()));
  if (!reads.cell().recipes.contains(run.recipe))
    return conflict("there is no result: this cell no longer has the run's recipe");
  const std::vector<StoredTouch> touches = reads.store().touches(id);
  if (touches.empty()) return conflict("there is no result: no touch has been made yet");
  Identified identified{recipe_of(run, cell), {}, {}};
  identified.problem = identification_problem(cell, identified.recipe);
  std::ranges::transform(touches, std::back_inserter(identified.problem.touches), to_touch);
  note_repeats(repeats_of(touches, reads.store().references(id), qualified_noise(run.conditions_json),
                          faces_per_place(cell.block, identified.recipe)),
               identified.problem);
  identified.result = calib::identify(identified.problem, identified.recipe.identification);
  if (identified.result.status == calib::IdentificationStatus::kConverged) return identified;
  return conflict("there is no result: " + identified.result.message);
} catch (const ConfigError& error) {
  return conflict(std::string("there is no result: ") + error.what());
}

std::optional<std::string> known_document(const Reads& reads, std::int64_t id) {
  if (auto stored = reads.store().result_json(id)) return stored;  // the run is over
  return reads.live_result(id);
}

RunRecord record_of(const Reads& reads, const StoredRun& run) {
  const RunStore& store = reads.store();
  RunRecord record{.run = run,
                   .touches = store.touches(run.id),
                   .superseded = store.superseded_touches(run.id),
                   .references = store.references(run.id),
                   .refused = refused_results(store, run.id),
                   .faults = FaultLog(store.database()).page(FaultLog::kKept, {}, run.id),
                   .result_json = {}};
  if (run.kind == RunKind::kCalibration) record.proofs = store.complete_runs_of(run.id, RunKind::kProof);
  HttpResponse result = get_result(reads, run.id);
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

std::optional<HttpResponse> refuse_format(const std::string& format) {
  if (format == "html" || format == "csv" || format == "json") return std::nullopt;
  return to_response({.status = 400,
                      .kind = ProblemKind::kQuery,
                      .detail = "format is html, csv or json; touchcal report makes a PDF of the first",
                      .parameter = "format"});
}

std::optional<HttpResponse> refuse_form(const ReportForm& form) {
  if (auto refused = refuse_format(form.format)) return refused;
  if (words_in(form.language)) return std::nullopt;
  return to_response({.status = 400,
                      .kind = ProblemKind::kQuery,
                      .detail = "language is en, fr or de; it is that of the html format",
                      .parameter = "language"});
}

/// The report of a calibration in a form that is not refused.
HttpResponse report_of(const Reads& reads, const RunRecord& record, const ReportForm& form) {
  // Once to text and back: replaces bytes from outside that are not UTF-8, for all formats.
  const std::string document = report_document(record);
  if (form.format == "json") return {.body = document};
  const RunReport report = read_report(document);
  if (form.format == "html")
    return saved_as("html", kHtml, record.run.id,
                    report_html(report, format_utc(reads.now()), *words_in(form.language)));
  return saved_as("csv", kCsv, record.run.id, report_csv(report));
}

/// The report of a proof or a check, made as that of a calibration is.
HttpResponse verification_report_of(const Reads& reads, const StoredRun& run, const ReportForm& form) {
  VerificationRecord record{.own = record_of(reads, run),
                            .cell = run.origin ? run.origin->cell : reads.cell().name,
                            .calibration = {},
                            .calibration_touches = {}};
  if (run.of_run) record.calibration = reads.store().run(*run.of_run);
  if (record.calibration) record.calibration_touches = reads.store().touches(*run.of_run);
  if (record.calibration && run.kind == RunKind::kCheck)
    record.checks = checks_view(*record.calibration, checks_until(reads.store(), *run.of_run, run),
                                reads.cell().arm.model, std::nullopt, reads.now());
  const std::string document = verification_report_document(record);
  if (form.format == "json") return {.body = document};
  const VerificationReport report = read_verification_report(document);
  if (form.format == "html")
    return saved_as("html", kHtml, run.id,
                    verification_html(report, format_utc(reads.now()), *words_in(form.language)));
  return saved_as("csv", kCsv, run.id, verification_report_csv(report));
}

/// A figure of a result that was made again on another machine, perhaps by another compiler.
bool is_same_figure(const std::optional<double>& told, const std::optional<double>& again) {
  constexpr double kRoundedShare = 1e-6;
  if (!told || !again) return told.has_value() == again.has_value();
  return std::abs(*again - *told) <= kRoundedShare * std::abs(*told);
}

/// Whether an identification made again has the errors and the uncertainty that are told of the first.
bool is_same_result(const ResultDocument& told, const Identified& again, const TipRegions& regions) {
  const auto parameters = parameters_of(again.problem, again.recipe.identification, again.result);
  if (!std::ranges::equal(told.parameters, parameters, is_same_figure, &Parameter::error, &Parameter::error))
    return false;
  if (!again.result.uncertainty) return !told.tip_uncertainty.workspace_box_rms_mm;
  const auto rms_m = predicted_rms_m(regions.tip().workspace_box, *again.result.uncertainty);
  return is_same_figure(told.tip_uncertainty.workspace_box_rms_mm,
                        rms_m ? std::optional(calib::mm_from_metres(*rms_m)) : std::nullopt);
}

void simulate(const Reads& reads, const Identified& again, int count, ResultDocument& told) {
  const auto figures = simulate_calibrations(reads.tip_regions(), again.problem, again.recipe.identification,
                                             again.result, count, 1, [&reads](int done) {
                                               (void)done;
                                               if (reads.is_ending())
                                                 throw std::runtime_error("the daemon ends");
                                             });
  if (figures) add_monte_carlo(*figures, told);
  if (auto missing = missing_draws(figures)) told.warnings.push_back(*std::move(missing));
}

}  // namespace

HttpResponse get_result(const Reads& reads, std::int64_t id) {
  if (auto document = known_document(reads, id)) return {.body = std::move(*document)};
  // A run that ended with the daemon has touches and no result: they are identified now.
  auto found = identify_stored(reads, id);
  if (auto* response = std::get_if<HttpResponse>(&found)) return std::move(*response);
  const Identified& identified = std::get<Identified>(found);
  const ResultContext context{
      .complete = false, .warnings = {}, .conditions = reads.store().run(id)->conditions_json.value_or("")};
  return {.body = result_document(reads.tip_regions(), identified.recipe, identified.problem,
                                  identified.result, context)};
}

HttpResponse get_arm(const Reads& reads, std::int64_t id) {
  if (auto stored = reads.store().arm_json(id)) return {.body = *std::move(stored)};
  const bool is_open = reads.store().run(id).value().outcome == RunOutcome::kRunning;
  return conflict(is_open ? "there is no calibrated arm yet: it is stored when the run ends"
                          : "no calibrated arm was stored: the run ended without a result that converged");
}

HttpResponse get_report(const Reads& reads, const StoredRun& run, const ReportForm& form) {
  if (const auto refused = refuse_form(form)) return *refused;
  if (run.kind != RunKind::kCalibration) return verification_report_of(reads, run, form);
  return report_of(reads, record_of(reads, run), form);
}

HttpResponse get_simulated_report(const Reads& reads, const StoredRun& run, const ReportForm& form,
                                  int count) {
  if (const auto refused = refuse_form(form)) return *refused;
  if (run.kind != RunKind::kCalibration)
    return conflict(
        fmt::format("run {} is a {}, which calibrates nothing that could be simulated; its report is without",
                    run.id, run_kind_name(run.kind)));
  if (run.outcome == RunOutcome::kRunning)
    return conflict("the run is not over: it has no result that stays");
  RunRecord record = record_of(reads, run);
  const auto found = identify_stored(reads, run.id);
  if (const auto* response = std::get_if<HttpResponse>(&found)) return *response;
  const Identified& again = std::get<Identified>(found);
  ResultDocument told = read_result(record.result_json.value());
  if (!is_same_result(told, again, reads.tip_regions()))
    return conflict(
        "this version of touchcal identifies the touches otherwise than when the run ended: a "
        "simulation would not be of its result; take the version that its conditions name");
  simulate(reads, again, count, told);
  record.result_json = document_text(told);
  return report_of(reads, record, form);
}

}  // namespace cell
