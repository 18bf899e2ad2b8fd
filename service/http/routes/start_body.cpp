#include "service/http/routes/internal/start_body.hpp"

#include <spdlog/fmt/fmt.h>

#include <nlohmann/json.hpp>

#include "config/config_error.hpp"
#include "config/strict_json.hpp"
#include "service/run/run_conditions.hpp"

namespace cell {
namespace {

using nlohmann::json;

constexpr std::size_t kOperatorBytesMax = 100;

Problem wrong(std::string pointer, std::string detail) {
  return {.kind = ProblemKind::kBody, .detail = std::move(detail), .pointer = std::move(pointer)};
}

std::optional<Problem> read_recipe(const json& body, const CellOperation& operation, StartRequest& start) {
  const bool by_plan = body.contains("plan_id");
  if (by_plan && body.contains("recipe")) return wrong("", "give one of 'recipe' or 'plan_id'");
  const char* key = by_plan ? "plan_id" : "recipe";
  const std::string pointer = pointer_step(key);
  const auto found = body.find(key);
  if (found == body.end() || !found->is_string())
    return wrong(pointer, "a string is required under 'recipe' or 'plan_id'");
  start.recipe = found->get<std::string>();
  if (!by_plan) return std::nullopt;
  const auto plan = operation.plan_with_id(start.recipe);
  if (!plan) {
    return Problem{.status = 404,
                   .kind = ProblemKind::kUnknownPlan,
                   .detail = fmt::format(
                       "this daemon has made no plan '{}'; POST /api/v1/plan makes it again", start.recipe),
                   .pointer = pointer};
  }
  start.recipe = plan->recipe;
  return std::nullopt;
}

std::optional<Problem> read_operator(const json& body, StartRequest& start) {
  if (const auto found = body.find("operator"); found != body.end()) {
    if (!found->is_string() || found->get_ref<const std::string&>().empty() ||
        found->get_ref<const std::string&>().size() > kOperatorBytesMax) {
      return wrong("/operator", fmt::format("a name of at most {} bytes is required", kOperatorBytesMax));
    }
    start.operator_name = found->get<std::string>();
  }
  return std::nullopt;
}

std::optional<Problem> read_touching(const json& body, StartRequest& start) {
  if (const auto found = body.find("touching"); found != body.end()) {
    const bool guided = *found == touch_mode_name(TouchMode::kGuided);
    if (!guided && *found != touch_mode_name(TouchMode::kAutomatic))
      return wrong("/touching", "must be 'automatic' or 'guided'");
    start.guided = guided;
  }
  return std::nullopt;
}

std::variant<StartRequest, Problem> read_body(const json& body, const CellOperation& operation) {
  if (!body.is_object()) return wrong("", "an object is required");
  for (const auto& [key, value] : body.items()) {
    if (key != "recipe" && key != "plan_id" && key != "operator" && key != "touching")
      return wrong(pointer_step(key),
                   "unknown key; 'recipe' or 'plan_id', 'operator' and 'touching' are known");
  }
  StartRequest start;
  if (auto problem = read_recipe(body, operation, start)) return *std::move(problem);
  if (auto problem = read_operator(body, start)) return *std::move(problem);
  if (auto problem = read_touching(body, start)) return *std::move(problem);
  return start;
}

}  // namespace

std::variant<StartRequest, Problem> read_start(const HttpRequest& request, const CellOperation& operation) {
  try {
    auto read = read_body(parse_strict_json("request body", request.body, kBodyBytesMax), operation);
    if (auto* start = std::get_if<StartRequest>(&read)) start->idempotency_key = request.idempotency_key;
    return read;
  } catch (const ConfigError& error) {
    return wrong(error.pointer(), error.what());
  }
}

}  // namespace cell
