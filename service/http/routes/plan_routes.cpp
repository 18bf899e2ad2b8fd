#include "service/http/routes/internal/plan_routes.hpp"

#include <spdlog/fmt/fmt.h>

#include <array>

#include "config/config_error.hpp"
#include "config/identification_problem.hpp"
#include "config/stiffness_choice.hpp"
#include "config/touches_file.hpp"
#include "service/acquisition/cell_operation.hpp"
#include "service/documents/result_view.hpp"
#include "service/http/routes/internal/request_body.hpp"
#include "service/http/routes/route_table.hpp"
#include "service/run/block_temperature.hpp"
#include "service/run/run_repeats.hpp"

namespace cell {
namespace {

constexpr std::array<std::string_view, 1> kPlanKeys{"recipe"};

/// A plan takes a few seconds.
constexpr int kPlanRetrySeconds = 5;

HttpResponse refuse(const PlanRefusal& refusal) {
  Problem problem{
      .status = 422, .kind = ProblemKind::kNoPlan, .detail = refusal.message, .pointer = "/recipe"};
  for (const std::string& line : effort_lines(refusal.efforts)) problem.errors.emplace_back("tried", line);
  return to_response(problem);
}

Asked ask_for_plan(const Call& call, CellOperation& operation) {
  const auto named = named_text(call.request.body, kPlanKeys);
  const auto* recipe = std::get_if<NamedText>(&named);
  if (!recipe || !operation.cell().recipes.contains(recipe->text)) return {};
  return {.plan = operation.planned(recipe->text)};
}

HttpResponse post_plan(const Call& call) {
  const auto named = named_text(call.request.body, kPlanKeys);
  if (const auto* problem = std::get_if<Problem>(&named)) return to_response(*problem);
  const std::string& recipe = std::get<NamedText>(named).text;
  if (!call.reads.cell().recipes.contains(recipe)) {
    return to_response({.status = 422,
                        .kind = ProblemKind::kUnknownRecipe,
                        .detail = fmt::format("there is no recipe '{}'", recipe),
                        .pointer = "/recipe"});
  }
  const auto& outcome = call.asked.plan;
  if (!outcome) {
    return to_response({.status = 503,
                        .kind = ProblemKind::kPlanning,
                        .detail = "another plan is being made; try again in a moment",
                        .retry_after_s = kPlanRetrySeconds});
  }
  if (const auto* refusal = std::get_if<PlanRefusal>(&*outcome)) return refuse(*refusal);
  return {.status = 200, .body = std::get<std::shared_ptr<const Plan>>(*outcome)->document};
}

HttpResponse post_identify(const Call& call) {
  const Cell& cell = call.reads.cell();
  const auto named = cell.recipes.find(call.text("recipe").value_or(cell.default_recipe));
  if (named == cell.recipes.end()) {
    return to_response({.status = 422,
                        .kind = ProblemKind::kUnknownRecipe,
                        .detail = "this cell has no such recipe; GET /api/v1/recipes lists them",
                        .parameter = "recipe"});
  }
  const auto choice = stiffness_choice_named(call.text("stiffness").value_or("auto"));
  if (!choice) {
    return to_response({.kind = ProblemKind::kQuery,
                        .detail = "stiffness is neither on, off nor auto",
                        .parameter = "stiffness"});
  }
  try {
    const Recipe recipe =
        call.text("stiffness") ? with_stiffness(named->second, *choice, cell) : named->second;
    TouchesFile file = touches_from_json("request body", call.request.body, kTouchesBytesMax, cell, recipe);
    if (auto warning = temperature_warning(cell, call.reads.now()))
      file.warnings.push_back(*std::move(warning));
    calib::IdentificationProblem problem = identification_problem(cell, recipe);
    note_repeats(file.repeats, problem);
    problem.touches = std::move(file.touches);
    const calib::IdentificationResult result = calib::identify(problem, recipe.identification);
    if (result.status != calib::IdentificationStatus::kConverged)
      return to_response({.status = 422,
                          .kind = ProblemKind::kNotIdentifiable,
                          .detail = result.message,
                          .pointer = "/touches"});
    return {.body = result_document(call.reads.tip_regions(), recipe, problem, result,
                                    {.warnings = std::move(file.warnings), .conditions = {}})};
  } catch (const ConfigError& error) {
    return to_response({.kind = ProblemKind::kBody, .detail = error.what(), .pointer = error.pointer()});
  }
}

}  // namespace

std::optional<std::string> recipe_to_plan(const HttpRequest& request, const CellOperation& operation) {
  const auto named = named_text(request.body, kPlanKeys);
  const auto* recipe = std::get_if<NamedText>(&named);
  if (!recipe || !operation.cell().recipes.contains(recipe->text) || operation.planned(recipe->text))
    return std::nullopt;
  return recipe->text;
}

HttpResponse get_plan(const Reads& reads, std::int64_t id) {
  if (auto document = reads.store().plan_json(id)) return {.status = 200, .body = *std::move(document)};
  return to_response({.status = 409,
                      .kind = ProblemKind::kNoPlan,
                      .detail = fmt::format("run {} has no plan that was kept", id)});
}

std::vector<Route> plan_routes() {
  return {
      {.method = "POST",
       .path = "/api/v1/plan",
       .summary = "Plans a recipe's touches; takes seconds the first time",
       .access = Access::kOperate,
       .handle = post_plan,
       .ask = ask_for_plan,
       .answers = {{.schema = "Plan"}},
       .body_schema = "PlanRequest",
       .dispatch = DispatchMode::kPlanning},
      {.method = "POST",
       .path = "/api/v1/identify",
       .summary = "Identifies the arm from a touches document; changes nothing",
       .access = Access::kOperate,
       .handle = post_identify,
       .answers = {{.schema = "Result"}},
       .query = {{.name = "recipe",
                  .words = "recipe whose options apply; the cell's default",
                  .is_text = true},
                 {.name = "stiffness",
                  .words = "on, off or auto: whether the compliance of the joints is estimated, in place of "
                           "the recipe's choice",
                  .is_text = true}},
       .body_schema = "Touches",
       .body_bytes_max = kTouchesBytesMax,
       .dispatch = DispatchMode::kWorker},
  };
}

}  // namespace cell
