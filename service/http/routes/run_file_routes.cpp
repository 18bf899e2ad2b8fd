#include <spdlog/fmt/fmt.h>

#include "service/base/utc_time.hpp"
#include "service/documents/document_error.hpp"
#include "service/documents/json_view.hpp"
#include "service/documents/run_file.hpp"
#include "service/http/routes/route_table.hpp"
#include "service/http/routes/services.hpp"
#include "service/store/model_store.hpp"
#include "service/store/run_copy.hpp"

namespace cell {
namespace {

/// The newest approval of the run; nothing when its model was never approved.
std::optional<std::string> model_of_run(const RunStore& store, std::int64_t run_id) {
  const ModelStore models(store.database());
  const auto history = models.history();
  for (auto row = history.rbegin(); row != history.rend(); ++row)
    if (row->run_id == run_id && row->kind == ApprovalKind::kApproved) return models.document(row->id);
  return std::nullopt;
}

HttpResponse get_file(const Call& call) {
  const RunStore& store = call.reads.store();
  const auto id = call.run_id();
  const auto run = id ? store.run(*id) : std::nullopt;
  if (!run) return not_found(fmt::format("there is no run '{}'; GET /api/v1/runs lists them", call.id));
  if (run->outcome == RunOutcome::kRunning)
    return to_response({.status = 409,
                        .kind = ProblemKind::kState,
                        .detail = fmt::format("run {} is not over; export it when it is", run->id)});
  return json_response(200, document_text(RunFile{.cell = call.reads.cell().name,
                                                  .exported_at = format_utc(call.reads.now()),
                                                  .copy = copy_of_run(store, *run),
                                                  .model_json = model_of_run(store, run->id)}));
}

/// The run of this file, as it is here afterwards. Its own of_run is a number of the other store.
HttpResponse import_file(const Call& call, const ReadRunFile& read) {
  const StoredRun& run = read.file.copy.run;
  RunImports& imports = call.services.imports;
  const RunOrigin origin{.cell = read.file.cell,
                         .run_id = run.id,
                         .exported_at = read.file.exported_at,
                         .imported_at = format_utc(call.reads.now()),
                         .sha256 = read.sha256};
  if (const auto here = imports.find(origin, run.started_at, call.reads.cell().name))
    return to_response({.status = 409,
                        .kind = ProblemKind::kKnownRun,
                        .detail = fmt::format("run {} of cell '{}' is here already, as run {}", run.id,
                                              origin.cell, *here)});
  const auto of_run = run.of_run ? imports.imported_run(origin.cell, *run.of_run) : std::nullopt;
  if (run.of_run && !of_run)
    return to_response({.status = 409,
                        .kind = ProblemKind::kState,
                        .detail = fmt::format("it is a {} of run {} of cell '{}', which is not here; import "
                                              "that run first",
                                              run_kind_name(run.kind), *run.of_run, origin.cell)});
  const std::int64_t id = imports.add(read.file.copy, origin, of_run);
  HttpResponse response = json_response(201, run_document(call.reads.store().run(id).value()));
  response.headers = {{"Location", fmt::format("/api/v1/runs/{}", id)}};
  return response;
}

HttpResponse post_import(const Call& call) {
  try {
    return import_file(call, read_run_file(call.request.body));
  } catch (const DocumentError& error) {
    return to_response(
        {.kind = ProblemKind::kBody, .detail = fmt::format("the file of the run: {}", error.what())});
  }
}

}  // namespace

std::vector<Route> run_file_routes() {
  return {{.method = "GET",
           .path = "/api/v1/runs/{id}/file",
           .summary = "A run that is over with all that is stored of it, to be imported by another daemon",
           .handle = get_file,
           .answers = {{.schema = "RunFile"}},
           .dispatch = DispatchMode::kStored},
          {.method = "POST",
           .path = "/api/v1/runs/import",
           .summary = "Takes a run of another daemon in, as a run of its own number; 409 when it is here",
           .access = Access::kOperate,
           .handle = post_import,
           .answers = {{.status = 201, .schema = "Run"}},
           .body_schema = "RunFile",
           .body_bytes_max = kRunFileBytesMax,
           .dispatch = DispatchMode::kWritten}};
}

}  // namespace cell
