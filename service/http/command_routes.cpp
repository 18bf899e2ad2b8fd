#include <spdlog/fmt/fmt.h>

#include "service/acquisition/cell_operation.hpp"
#include "service/http/refusals.hpp"
#include "service/http/route_table.hpp"
#include "service/http/services.hpp"

namespace cell {
namespace {

HttpResponse give(const Call& call, Command command, std::optional<std::int64_t> run_id) {
  if (const auto refusal = call.operation.command(command, run_id))
    return from_refusal(*refusal, call.operation);
  return json_response(202, call.services.feed.document());
}

template <Command kCommand>
HttpResponse run_command(const Call& call) {
  const auto id = call.run_id();
  if (!id || !call.operation.store().run(*id)) return not_found(fmt::format("there is no run '{}'", call.id));
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
      command("/api/v1/runs/{id}/pause", "Holds the run behind the touch under way",
              run_command<Command::kPause>),
      command("/api/v1/runs/{id}/resume", "Goes on with a run on hold", run_command<Command::kResume>),
      command("/api/v1/runs/{id}/retry", "Makes the touch again that holds the run",
              run_command<Command::kRetry>),
      command("/api/v1/runs/{id}/skip", "Leaves the touch out that holds the run, which stays incomplete",
              run_command<Command::kSkip>),
      command("/api/v1/runs/{id}/abort", "Stops the arm where it is and ends the run",
              run_command<Command::kAbort>),
      command("/api/v1/cell/stop", "Stops the arm and ends the run; always taken",
              cell_command<Command::kStop>),
      command("/api/v1/cell/confirm", "Tells what is to be confirmed at the cell, where the key is",
              cell_command<Command::kConfirm>),
      command("/api/v1/cell/touch-test", "Tells how the touch test of the stylus stands",
              cell_command<Command::kTouchTest>),
      command("/api/v1/cell/take", "Takes the joints where the stylus touches now",
              cell_command<Command::kTake>),
      command("/api/v1/cell/undo", "Takes the last touch back that a person made",
              cell_command<Command::kUndo>),
      command("/api/v1/cell/locate", "Finds out where the block is, by six guided touches",
              cell_command<Command::kLocate>),
      command("/api/v1/cell/acknowledge", "Takes note of the fault that is shown",
              cell_command<Command::kAcknowledge>),
      command("/api/v1/cell/clear", "Leaves ABORTED once the cause is gone", cell_command<Command::kClear>),
      command("/api/v1/cell/reset", "Looks for the controller and makes ready",
              cell_command<Command::kReset>),
  };
}

HttpResponse from_refusal(const CommandRefusal& refusal, const CellOperation& operation) {
  Problem problem{.status = 409, .kind = "state", .detail = refusal.detail};
  switch (refusal.kind) {
    case CommandRefusal::Kind::kState:
      break;
    case CommandRefusal::Kind::kPreconditions:
      problem.kind = "preconditions";
      break;
    case CommandRefusal::Kind::kUnknownRecipe:
      problem.status = 422;
      problem.kind = "unknown-recipe";
      problem.pointer = "/recipe";
      break;
    case CommandRefusal::Kind::kOtherKey:
      problem.status = 422;
      problem.kind = "idempotency-key";
      break;
    case CommandRefusal::Kind::kNotThisRun:
      problem.kind = "not-this-run";
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
