#include <spdlog/fmt/fmt.h>

#include <nlohmann/json.hpp>

#include "service/acquisition/cell_operation.hpp"
#include "service/http/json_figures.hpp"
#include "service/http/result_routes.hpp"
#include "service/report/report_document.hpp"
#include "service/report/report_html.hpp"
#include "service/store/fault_log.hpp"

namespace cell {
namespace {

RunRecord record_of(const CellOperation& operation, const StoredRun& run) {
  const TouchStore& store = operation.store();
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

/// It is opened from where it was saved: the daemon's own pages allow no styles of a document.
HttpResponse saved_as(std::string_view ending, std::string_view type, std::int64_t run, std::string body) {
  return {.content_type = std::string(type),
          .body = std::move(body),
          .headers = {{"Content-Disposition",
                       fmt::format("attachment; filename=\"touchcal-run-{}.{}\"", run, ending)}}};
}

}  // namespace

HttpResponse get_report(const CellOperation& operation, const StoredRun& run, const std::string& format) {
  if (format != "html" && format != "csv" && format != "json") {
    return to_response({.status = 400,
                        .kind = "query",
                        .detail = "format is html, csv or json; touchcal report makes a PDF of the first",
                        .parameter = "format"});
  }
  // Once as text and back: what came from outside and is no UTF-8 is none in any of the forms.
  const std::string document = text_of(report_json(record_of(operation, run)));
  if (format == "json") return {.body = document};
  const Json report = Json::parse(document);
  if (format == "html") return saved_as("html", kHtml, run.id, report_html(report));
  return saved_as("csv", kCsv, run.id, report_csv(report));
}

}  // namespace cell
