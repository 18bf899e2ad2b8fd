#include <spdlog/fmt/fmt.h>
#include <spdlog/spdlog.h>

#include "service/acquisition/cell_operation.hpp"
#include "service/documents/conditions_view.hpp"
#include "service/documents/json_view.hpp"
#include "service/http/routes/internal/plan_routes.hpp"
#include "service/http/routes/internal/refusals.hpp"
#include "service/http/routes/internal/result_routes.hpp"
#include "service/http/routes/internal/start_body.hpp"
#include "service/http/routes/route_table.hpp"
#include "service/run/simulated_calibrations.hpp"
#include "service/store/run_page.hpp"

namespace cell {
namespace {

constexpr int kRunsPageDefault = 50;
constexpr int kRunsPageMax = 200;
constexpr int kReportDrawsDefault = 1000;
constexpr std::int64_t kRunIdMax = std::int64_t{1} << 53;

HttpResponse get_runs(const Call& call) {
  const int limit = static_cast<int>(call.number("limit").value_or(kRunsPageDefault));
  const RunPage page = run_page(call.reads.store(), limit, call.number("before"));
  for (const DamagedRun& run : page.damaged) spdlog::error("{}", run.what);
  return json_response(200, runs_document(page));
}

HttpResponse run_view(const Call& call, const StoredRun& run) {
  (void)call;
  return json_response(200, run_document(run));
}
HttpResponse touches_view(const Call& call, const StoredRun& run) {
  const RunStore& store = call.reads.store();
  const auto& recipes = call.reads.cell().recipes;
  const auto recipe = recipes.find(run.recipe);
  return json_response(200, touches_document(call.reads.cell(), store.touches(run.id),
                                             store.references(run.id), qualified_noise(run.conditions_json),
                                             recipe == recipes.end() ? nullptr : &recipe->second));
}
HttpResponse result_view(const Call& call, const StoredRun& run) { return get_result(call.reads, run.id); }
HttpResponse arm_view(const Call& call, const StoredRun& run) { return get_arm(call.reads, run.id); }
ReportForm form_in(const Call& call) {
  ReportForm form;
  form.format = call.text("format").value_or(form.format);
  form.language = call.text("language").value_or(form.language);
  return form;
}
HttpResponse report_view(const Call& call, const StoredRun& run) {
  return get_report(call.reads, run, form_in(call));
}
HttpResponse simulated_report_view(const Call& call, const StoredRun& run) {
  const auto count = static_cast<int>(call.number("count").value_or(kReportDrawsDefault));
  return get_simulated_report(call.reads, run, form_in(call), count);
}
HttpResponse plan_view(const Call& call, const StoredRun& run) { return get_plan(call.reads, run.id); }

template <HttpResponse (*kView)(const Call&, const StoredRun&)>
HttpResponse of_run(const Call& call) {
  const auto id = call.run_id();
  const auto run = id ? call.reads.store().run(*id) : std::nullopt;
  if (!run) return not_found(fmt::format("there is no run '{}'; GET /api/v1/runs lists them", call.id));
  return kView(call, *run);
}

Asked ask_to_start(const Call& call, CellOperation& operation) {
  auto read = read_start(*call.start, operation);
  if (auto* problem = std::get_if<Problem>(&read)) return {.problem = std::move(*problem)};
  StartRequest start = std::get<StartRequest>(std::move(read));
  start.idempotency_key = call.request.idempotency_key;
  return {.to_start = std::move(start)};
}

HttpResponse post_runs(const Call& call) {
  if (call.asked.problem) return to_response(*call.asked.problem);
  if (call.asked.refusal) return refusal_response(*call.asked.refusal, call.asked.exits);
  const StoredRun& run = call.asked.started.value().run;
  HttpResponse response = json_response(201, run_document(run));
  response.headers = {{"Location", fmt::format("/api/v1/runs/{}", run.id)}};
  return response;
}

}  // namespace

std::vector<Route> run_routes() {
  const auto read = [](std::string_view path, std::string_view summary, HttpResponse (*handle)(const Call&),
                       std::string_view schema) {
    return Route{.method = "GET",
                 .path = path,
                 .summary = summary,
                 .handle = handle,
                 .answers = {{.schema = schema}},
                 .dispatch = DispatchMode::kStored};
  };
  Route list = read("/api/v1/runs", "The history, newest first, in pages", get_runs, "Runs");
  list.query = {{"limit", 1, kRunsPageMax, "runs on a page"},
                {"before", 0, kRunIdMax, "only runs before this id: next_before of the page before"}};
  Route result = read("/api/v1/runs/{id}/result", "The latest result; 409 before there is one",
                      of_run<result_view>, "RunResult");
  Route arm =
      read("/api/v1/runs/{id}/arm", "The calibrated arm as stored when the run ended; 409 when none was",
           of_run<arm_view>, "Arm");
  result.tells_result = true;
  arm.tells_result = true;
  return {
      list,
      {.method = "POST",
       .path = "/api/v1/runs",
       .summary = "Starts a run; 409 names all unmet preconditions at once",
       .access = Access::kOperate,
       .handle = post_runs,
       .ask = ask_to_start,
       .answers = {{.status = 201, .schema = "Run"}},
       .body_schema = "StartRequest",
       .starts_run = true},
      read("/api/v1/runs/{id}", "One run", of_run<run_view>, "Run"),
      read("/api/v1/runs/{id}/touches", "The touches so far, as touchcal identify reads them",
           of_run<touches_view>, "Touches"),
      result,
      arm,
      read("/api/v1/runs/{id}/plan", "The plan of the run; 409 before it is made", of_run<plan_view>, "Plan"),
      {.method = "GET",
       .path = "/api/v1/runs/{id}/report",
       .summary = "The report of the run",
       .handle = of_run<report_view>,
       .answers = {{.content_type = kHtml}, {.content_type = kCsv}, {.schema = "RunReport"}},
       .query = {{.name = "format", .words = "html, csv or json; html by default", .is_text = true},
                 {.name = "language", .words = "of the html: en, fr or de; en by default", .is_text = true}},
       .dispatch = DispatchMode::kStored,
       .tells_result = true},
      {.method = "POST",
       .path = "/api/v1/runs/{id}/report/monte-carlo",
       .summary = "The report of a calibration that is over with simulated calibrations beside its linear "
                  "uncertainty; takes about a millisecond for each",
       .access = Access::kOperate,
       .handle = of_run<simulated_report_view>,
       .answers = {{.content_type = kHtml}, {.content_type = kCsv}, {.schema = "Report"}},
       .query = {{"count", kReportDrawsMin, kReportDrawsMax, "simulated calibrations; 1000 by default"},
                 {.name = "format", .words = "html, csv or json; html by default", .is_text = true},
                 {.name = "language", .words = "of the html: en, fr or de; en by default", .is_text = true}},
       .dispatch = DispatchMode::kWorker},
  };
}

}  // namespace cell
