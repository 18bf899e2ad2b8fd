#include <spdlog/fmt/fmt.h>

#include "service/acquisition/cell_operation.hpp"
#include "service/http/routes/internal/refusals.hpp"
#include "service/http/routes/route_table.hpp"
#include "service/http/routes/services.hpp"

namespace cell {
namespace {

Asked give(CellOperation& operation, Command command, std::optional<std::int64_t> run_id) {
  Asked asked{.refusal = operation.command(command, run_id)};
  if (asked.refusal) asked.exits = operation.exits();
  asked.needs_store = asked.refusal && asked.refusal->kind == CommandRefusal::Kind::kNotThisRun;
  asked.is_storing = !asked.refusal && (command == Command::kTake || command == Command::kUndo);
  return asked;
}

template <Command kCommand>
Asked give_to_run(const Call& call, CellOperation& operation) {
  const auto id = call.run_id();
  if (!id) return {};  // there is no such run
  return give(operation, kCommand, id);
}

template <Command kCommand>
Asked give_to_cell(const Call&, CellOperation& operation) {
  return give(operation, kCommand, std::nullopt);
}

HttpResponse answer_command(const Call& call) {
  if (call.asked.refusal) return refusal_response(*call.asked.refusal, call.asked.exits);
  return json_response(202, call.services.feed.document());
}

/// A run that is under way takes its command without the database, which a pause or an abort must not need.
HttpResponse answer_run_command(const Call& call) {
  const auto id = call.run_id();
  if (!id || (call.asked.needs_store && !call.reads.store().run(*id)))
    return not_found(fmt::format("there is no run '{}'", call.id));
  return answer_command(call);
}

Route command(std::string_view path, std::string_view summary, HttpResponse (*handle)(const Call&),
              Asked (*ask)(const Call&, CellOperation&)) {
  return {.method = "POST",
          .path = path,
          .summary = summary,
          .access = Access::kOperate,
          .handle = handle,
          .ask = ask,
          .answers = {{.status = 202, .schema = "Status"}}};
}

template <Command kCommand>
Route run_command(std::string_view path, std::string_view summary) {
  return command(path, summary, answer_run_command, give_to_run<kCommand>);
}

template <Command kCommand>
Route cell_command(std::string_view path, std::string_view summary) {
  return command(path, summary, answer_command, give_to_cell<kCommand>);
}

/// Also of somebody who may only look, and of a session that is over.
Route stop_command() {
  Route stop =
      cell_command<Command::kStop>("/api/v1/cell/stop", "Stops the arm and ends the run; always taken");
  stop.access = Access::kStop;
  return stop;
}

}  // namespace

std::vector<Route> command_routes() {
  return {
      run_command<Command::kPause>("/api/v1/runs/{id}/pause", "Holds the run after the touch under way"),
      run_command<Command::kResume>("/api/v1/runs/{id}/resume", "Continues a run on hold"),
      run_command<Command::kRetry>("/api/v1/runs/{id}/retry", "Repeats the touch that holds the run"),
      run_command<Command::kSkip>("/api/v1/runs/{id}/skip",
                                  "Leaves out the touch that holds the run, which stays incomplete"),
      run_command<Command::kAbort>("/api/v1/runs/{id}/abort", "Stops the arm where it is and ends the run"),
      stop_command(),
      cell_command<Command::kConfirm>("/api/v1/cell/confirm",
                                      "Reports what to confirm at the cell, with the key there"),
      cell_command<Command::kTouchTest>("/api/v1/cell/touch-test",
                                        "Reports the state of the touch test of the stylus"),
      cell_command<Command::kTake>("/api/v1/cell/take", "Records the present contact of the stylus"),
      cell_command<Command::kUndo>("/api/v1/cell/undo", "Discards the last touch made by hand"),
      cell_command<Command::kLocate>("/api/v1/cell/locate", "Locates the block by six guided touches"),
      cell_command<Command::kAcknowledge>("/api/v1/cell/acknowledge", "Acknowledges the fault"),
      cell_command<Command::kClear>("/api/v1/cell/clear", "Leaves ABORTED once the cause is removed"),
      cell_command<Command::kReset>(
          "/api/v1/cell/reset",
          "Connects to the controller, takes an arm that stands at a face back once that is "
          "confirmed at the cell, and makes the cell ready"),
  };
}

Problem not_recorded() {
  return {.status = 503,
          .kind = ProblemKind::kAudit,
          .detail =
              "the command was refused because it cannot be recorded; free space on the disk of the "
              "state directory, or end the program that has the database locked. Stop, abort and pause "
              "are still executed, and so is what takes from a person what they may"};
}

HttpResponse refusal_response(const CommandRefusal& refusal, const std::vector<Command>& exits) {
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
    case CommandRefusal::Kind::kUnknownRun:
      problem.status = 422;
      problem.kind = ProblemKind::kBody;
      problem.pointer = "/of_run";
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
  for (const Command command : exits) problem.exits.emplace_back(command_name(command));
  return to_response(problem);
}

}  // namespace cell
