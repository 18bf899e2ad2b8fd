#include "config/config_error.hpp"
#include "config/identification_problem.hpp"
#include "config/touches_file.hpp"
#include "service/acquisition/cell_operation.hpp"
#include "service/http/plan_routes.hpp"
#include "service/http/result_view.hpp"
#include "service/http/route_table.hpp"

namespace cell {
namespace {

HttpResponse post_a_plan(const Call& call) { return post_plan(call.request, call.operation); }

HttpResponse post_identify(const Call& call) {
  const Cell& cell = call.cell;
  const auto named = cell.recipes.find(call.text("recipe").value_or(cell.default_recipe));
  if (named == cell.recipes.end()) {
    return to_response({.status = 422,
                        .kind = "unknown-recipe",
                        .detail = "this cell has no such recipe; GET /api/v1/recipes lists them",
                        .parameter = "recipe"});
  }
  const Recipe& recipe = named->second;
  try {
    TouchesFile file = touches_from_json("request body", call.request.body, kTouchesBytesMax, cell);
    calib::IdentificationProblem problem = identification_problem(cell, recipe);
    problem.touches = std::move(file.touches);
    const calib::IdentificationResult result = calib::identify(problem, recipe.identification);
    if (result.status != calib::IdentificationStatus::kConverged)
      return to_response(
          {.status = 422, .kind = "not-identifiable", .detail = result.message, .pointer = "/touches"});
    const TipRegions regions(cell);  // the operation's are for the thread of the sockets
    return {.body = result_document(regions, recipe, problem, result,
                                    {.warnings = std::move(file.warnings), .conditions = {}})};
  } catch (const ConfigError& error) {
    return to_response({.kind = "body", .detail = error.what(), .pointer = error.pointer()});
  }
}

}  // namespace

std::vector<Route> planning_routes() {
  return {
      {.method = "POST",
       .path = "/api/v1/plan",
       .summary = "Plans a recipe's touches; takes seconds the first time",
       .access = Access::kOperate,
       .handle = post_a_plan,
       .answers = {{.schema = "Plan"}},
       .body_schema = "PlanRequest",
       .pace = Pace::kPlanning},
      {.method = "POST",
       .path = "/api/v1/identify",
       .summary = "Identifies the arm from a touches document; touches nothing else",
       .access = Access::kOperate,
       .handle = post_identify,
       .answers = {{.schema = "Result"}},
       .query = {{.name = "recipe", .words = "whose options to take; the cell's default", .is_text = true}},
       .body_schema = "Touches",
       .body_bytes_max = kTouchesBytesMax,
       .pace = Pace::kWorker},
  };
}

}  // namespace cell
