#include "service/http/plan_routes.hpp"

#include <spdlog/fmt/fmt.h>

#include <array>

#include "service/acquisition/cell_operation.hpp"
#include "service/http/request_body.hpp"

namespace cell {
namespace {

constexpr std::array<std::string_view, 1> kPlanKeys{"recipe"};

/// A plan takes a few seconds.
constexpr const char* kRetryAfterSeconds = "5";

HttpResponse refuse(const PlanRefusal& refusal) {
  Problem problem{.status = 422, .kind = "no-plan", .detail = refusal.message, .pointer = "/recipe"};
  for (const std::string& line : effort_lines(refusal.efforts)) problem.errors.emplace_back("tried", line);
  return to_response(problem);
}

}  // namespace

HttpResponse post_plan(const HttpRequest& request, const CellOperation& operation) {
  const auto named = named_text(request.body, kPlanKeys);
  if (const auto* problem = std::get_if<Problem>(&named)) return to_response(*problem);
  const std::string& recipe = std::get<NamedText>(named).text;
  if (!operation.cell().recipes.contains(recipe)) {
    return to_response({.status = 422,
                        .kind = "unknown-recipe",
                        .detail = fmt::format("there is no recipe '{}'", recipe),
                        .pointer = "/recipe"});
  }
  const auto outcome = operation.planned(recipe);
  if (!outcome) {
    HttpResponse busy = to_response(
        {.status = 503, .kind = "planning", .detail = "another plan is being made; ask again in a moment"});
    busy.headers.emplace_back("Retry-After", kRetryAfterSeconds);
    return busy;
  }
  if (const auto* refusal = std::get_if<PlanRefusal>(&*outcome)) return refuse(*refusal);
  return {.status = 200, .body = std::get<std::shared_ptr<const Plan>>(*outcome)->document};
}

std::optional<std::string> recipe_to_plan(const HttpRequest& request, const CellOperation& operation) {
  const auto named = named_text(request.body, kPlanKeys);
  const auto* recipe = std::get_if<NamedText>(&named);
  if (!recipe || !operation.cell().recipes.contains(recipe->text) || operation.planned(recipe->text))
    return std::nullopt;
  return recipe->text;
}

HttpResponse get_plan(const CellOperation& operation, std::int64_t id) {
  if (auto document = operation.store().plan_json(id)) return {.status = 200, .body = *std::move(document)};
  return to_response(
      {.status = 409, .kind = "no-plan", .detail = fmt::format("run {} has no plan that was kept", id)});
}

}  // namespace cell
