#include <spdlog/fmt/fmt.h>

#include "service/acquisition/cell_operation.hpp"
#include "service/http/routes/internal/refusals.hpp"
#include "service/http/routes/route_table.hpp"
#include "service/http/routes/services.hpp"

namespace cell {
namespace {

HttpResponse give(const Call& call, Command command, std::optional<std::int64_t> run_id) {
  if (const auto refusal = call.operation.command(command, run_id))
    return refusal_response(*refusal, call.operation);
  return json_response(202, call.services.feed.document());
}

/// The run under way is known without the database, which a pause or an abort must not need.
bool has_run(const Call& call, std::int64_t id) {
  return call.operation.status().run_id == id || call.operation.store().run(id);
}

template <Command kCommand>
HttpResponse run_command(const Call& call) {
  const auto id = call.run_id();
  if (!id || !has_run(call, *id)) return not_found(fmt::format("there is no run '{}'", call.id));
  return give(call, kCommand, id);
}

template <Command kCommand>
HttpResponse cell_command(const Call& call) {
  return give(call, kCommand, std::nullopt);
}

Route command(std::string_view path, std::string_view summary, HttpResponse (*handle)(const Call&)) {
  return {.method = "POST",
          .path = path,
          .summary = summary,
          .access = Access::kOperate,
          .handle = handle,
          .answers = {{.status = 202, .schema = "Status"}}};
}

}  // namespace

std::vector<Route> command_routes() {
  return {
      command("/api/v1/runs/{id}/pause", "Holds the run after the touch under way",
              run_command<Command::kPause>),
      command("/api/v1/runs/{id}/resume", "Continues a run on hold", run_command<Command::kResume>),
      command("/api/v1/runs/{id}/retry", "Repeats the touch that holds the run",
              run_command<Command::kRetry>),
      command("/api/v1/runs/{id}/skip", "Leaves out the touch that holds the run, which stays incomplete",
              run_command<Command::kSkip>),
      command("/api/v1/runs/{id}/abort", "Stops the arm where it is and ends the run",
              run_command<Command::kAbort>),
      command("/api/v1/cell/stop", "Stops the arm and ends the run; always taken",
              cell_command<Command::kStop>),
      command("/api/v1/cell/confirm", "Reports what to confirm at the cell, with the key there",
              cell_command<Command::kConfirm>),
      command("/api/v1/cell/touch-test", "Reports the state of the touch test of the stylus",
              cell_command<Command::kTouchTest>),
      command("/api/v1/cell/take", "Records the present contact of the stylus", cell_command<Command::kTake>),
      command("/api/v1/cell/undo", "Discards the last touch made by hand", cell_command<Command::kUndo>),
      command("/api/v1/cell/locate", "Locates the block by six guided touches",
              cell_command<Command::kLocate>),
      command("/api/v1/cell/acknowledge", "Acknowledges the fault", cell_command<Command::kAcknowledge>),
      command("/api/v1/cell/clear", "Leaves ABORTED once the cause is removed",
              cell_command<Command::kClear>),
      command("/api/v1/cell/reset", "Connects to the controller and makes the cell ready",
              cell_command<Command::kReset>),
  };
}

HttpResponse refusal_response(const CommandRefusal& refusal, const CellOperation& operation) {
  Problem problem{.status = 409, .kind = ProblemKind::kState, .detail = refusal.detail};
  switch (refusal.kind) {
    case CommandRefusal::Kind::kState:
      break;
    case CommandRefusal::Kind::kPreconditions:
      problem.kind = ProblemKind::kPreconditions;
      break;
    case CommandRefusal::Kind::kUnknownRecipe:
      problem.status = 422;
      problem.kind = ProblemKind::kUnknownRecipe;
      problem.pointer = "/recipe";
      break;
    case CommandRefusal::Kind::kOtherKey:
      problem.status = 422;
      problem.kind = ProblemKind::kIdempotencyKey;
      break;
    case CommandRefusal::Kind::kNotThisRun:
      problem.kind = ProblemKind::kNotThisRun;
      break;
  }
  for (const Unmet& unmet : refusal.unmet) problem.errors.emplace_back(unmet.code, unmet.detail);
  if (!refusal.unmet.empty()) {
    problem.detail += ": ";
    for (const Unmet& unmet : refusal.unmet)
      problem.detail += (&unmet == refusal.unmet.data() ? "" : "; ") + unmet.detail;
  }
  for (const Command command : operation.exits()) problem.exits.emplace_back(command_name(command));
  return to_response(problem);
}

}  // namespace cell
