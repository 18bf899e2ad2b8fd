#include "service/http/routes/internal/start_body.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>

#include "config/block_file.hpp"
#include "config/config_error.hpp"
#include "config/json_value.hpp"
#include "config/mounted_tool.hpp"
#include "config/stiffness_choice.hpp"
#include "config/strict_json.hpp"
#include "config/utc_text.hpp"
#include "service/http/routes/route_table.hpp"
#include "service/run/run_conditions.hpp"

namespace cell {

struct StartBody {
  nlohmann::json json = {};
  std::string signed_in = {};
  std::optional<Problem> problem = {};  // of a text that is no JSON
};

namespace {

using nlohmann::json;

constexpr std::size_t kOperatorBytesMax = 100;

constexpr std::array<std::string_view, 12> kStartKeys{"recipe",
                                                      "plan_id",
                                                      "kind",
                                                      "of_run",
                                                      "tool",
                                                      "operator",
                                                      "touching",
                                                      "block_temperature_c",
                                                      "std_block_temperature_k",
                                                      "block_temperature_at",
                                                      "arm_moving_min",
                                                      "stiffness"};

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

std::optional<Problem> read_operator(const json& body, const std::string& signed_in, StartRequest& start) {
  std::optional<std::string> named;
  if (const auto found = body.find("operator"); found != body.end()) {
    if (!found->is_string() || !is_operator_name(found->get_ref<const std::string&>()))
      return wrong("/operator", operator_name_is());
    named = found->get<std::string>();
  }
  auto operator_name = read_operator_of(signed_in, named);
  if (auto* problem = std::get_if<Problem>(&operator_name)) return std::move(*problem);
  start.operator_name = std::get<0>(std::move(operator_name));
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

/// Whoever asks for a kind that there is not must not get a calibration.
std::optional<Problem> read_kind(const json& body, StartRequest& start) {
  if (const auto found = body.find("kind"); found != body.end()) {
    const auto kind =
        found->is_string() ? run_kind_named(found->get_ref<const std::string&>()) : std::nullopt;
    if (!kind)
      return wrong("/kind",
                   "must be 'calibration', 'proof', 'check', 'qualification' or 'tool'; or leave it out");
    start.kind = *kind;
  }
  if (start.kind != RunKind::kTool && body.contains("tool"))
    return wrong("/tool", "is what a run of the kind 'tool' touches with; leave it out");
  const auto of_run = body.find("of_run");
  if (of_run == body.end()) return std::nullopt;
  if (start.kind == RunKind::kCalibration)
    return wrong("/of_run", "is the calibration that another kind of run is of; leave it out");
  start.of_run = of_run->is_string() ? run_id_of(of_run->get_ref<const std::string&>()) : std::nullopt;
  if (start.of_run) return std::nullopt;
  return wrong("/of_run", "the id of a run, a string of digits, is required");
}

/// A person makes the touches of a tool: nothing is known of its shape, so that nothing may move by it.
std::optional<Problem> read_tool(const json& body, const Cell& cell, StartRequest& start) {
  const auto tool = body.find("tool");
  if (tool == body.end() || !tool->is_string())
    return wrong("/tool", "the name of one of the cell's tools, a string, is required");
  if (body.contains("touching") && !start.guided)
    return wrong("/touching", "the touches of a tool are made by a person: 'guided', or leave it out");
  start.tool = tool->get<std::string>();
  if (!cell.tool_tips.contains(start.tool)) return wrong("/tool", why_no_tip(cell, start.tool));
  start.guided = true;
  return std::nullopt;
}

/// A proof and a check have the recipe and the choices of their calibration, and are touched by the arm. A
/// recipe that is named has to be that one; a qualification has none.
std::optional<Problem> read_of_verification(const json& body, const Cell& cell, StartRequest& start) {
  for (const char* key : {"plan_id", "stiffness"}) {
    if (body.contains(key))
      return wrong(pointer_step(key), fmt::format("a {} takes it from its calibration; leave it out",
                                                  run_kind_name(start.kind)));
  }
  if (const auto recipe = body.find("recipe"); recipe != body.end()) {
    if (start.kind == RunKind::kQualification)
      return wrong("/recipe", "a qualification has touches of its own; leave it out");
    if (!recipe->is_string()) return wrong("/recipe", "a string is required");
    start.recipe = recipe->get<std::string>();
  }
  if (start.kind == RunKind::kTool) return read_tool(body, cell, start);
  if (!start.guided) return std::nullopt;
  return wrong("/touching", fmt::format("the touches of a {} are made by the arm itself: 'automatic'",
                                        run_kind_name(start.kind)));
}

bool is_number_within(const json& value, double min, double max) {
  return value.is_number() && value.get<double>() >= min && value.get<double>() <= max;
}

/// All of them or none; a plan was made for the temperature of the block's file.
std::optional<Problem> refuse_temperature_keys(const json& body) {
  const bool has_value = body.contains("block_temperature_c");
  const bool has_std = body.contains("std_block_temperature_k");
  if (has_value && !has_std)
    return wrong("/std_block_temperature_k",
                 "is missing beside block_temperature_c; give the standard deviation of the temperature");
  if (!has_value && (has_std || body.contains("block_temperature_at")))
    return wrong("/block_temperature_c",
                 "is missing; give the temperature that the standard deviation or the time is of");
  if (has_value && body.contains("plan_id"))
    return wrong("/block_temperature_c",
                 "cannot be given with a plan, which was made for the temperature of the block's file; give "
                 "the recipe in place of the plan");
  return std::nullopt;
}

std::optional<Problem> read_temperature(const json& body, std::chrono::system_clock::time_point now,
                                        StartRequest& start) {
  if (auto problem = refuse_temperature_keys(body)) return problem;
  const auto value = body.find("block_temperature_c");
  if (value == body.end()) return std::nullopt;
  if (!is_number_within(*value, kBlockTemperatureMinC, kBlockTemperatureMaxC))
    return wrong("/block_temperature_c", fmt::format("a number from {} to {} degrees C is required",
                                                     kBlockTemperatureMinC, kBlockTemperatureMaxC));
  const json& deviation = body.at("std_block_temperature_k");
  if (!is_number_within(deviation, kPositive.min, kBlockTemperatureStdMaxK))
    return wrong("/std_block_temperature_k",
                 fmt::format("a number over 0 and up to {} K is required", kBlockTemperatureStdMaxK));
  start.block_temperature =
      BlockTemperature{.celsius = value->get<double>(), .std_k = deviation.get<double>(), .measured_at = now};
  const auto at = body.find("block_temperature_at");
  if (at == body.end()) return std::nullopt;
  start.block_temperature->measured_at =
      at->is_string() ? time_from_utc(at->get_ref<const std::string&>()) : std::nullopt;
  if (start.block_temperature->measured_at) return std::nullopt;
  return wrong("/block_temperature_at", "a time in UTC such as '2026-01-31T08:15:30Z' is required");
}

std::optional<Problem> read_warm_up(const json& body, StartRequest& start) {
  const auto found = body.find("arm_moving_min");
  if (found == body.end()) return std::nullopt;
  if (!is_number_within(*found, 0.0, kArmMovingMaxMin))
    return wrong("/arm_moving_min",
                 fmt::format("a number of minutes from 0 to {} is required", kArmMovingMaxMin));
  start.arm_moving_min = found->get<double>();
  return std::nullopt;
}

/// A plan was made with the recipe's own choice.
std::optional<Problem> read_stiffness(const json& body, const Cell& cell, StartRequest& start) {
  const auto found = body.find("stiffness");
  if (found == body.end()) return std::nullopt;
  const std::string pointer = "/stiffness";
  start.stiffness =
      found->is_string() ? stiffness_choice_named(found->get_ref<const std::string&>()) : std::nullopt;
  if (!start.stiffness) return wrong(pointer, "must be 'on', 'off' or 'auto'; or leave it out");
  if (body.contains("plan_id"))
    return wrong(pointer,
                 "cannot be given with a plan, which was made with the recipe's choice; give the recipe in "
                 "place of the plan");
  if (*start.stiffness == StiffnessChoice::kOn && !can_estimate_stiffness(cell.arm)) {
    return wrong(pointer, fmt::format("the arm '{}' has no masses or no std_compliance_rad_per_nm; add "
                                      "\"gravity\" to its file or give 'off'",
                                      cell.arm.name));
  }
  return std::nullopt;
}

std::variant<StartRequest, Problem> read_body(const json& body, const std::string& signed_in,
                                              const CellOperation& operation) {
  if (!body.is_object()) return wrong("", "an object is required");
  for (const auto& [key, value] : body.items()) {
    if (std::ranges::find(kStartKeys, key) == kStartKeys.end())
      return wrong(pointer_step(key), fmt::format("unknown key; known are {}", fmt::join(kStartKeys, ", ")));
  }
  StartRequest start;
  if (auto problem = read_kind(body, start)) return *std::move(problem);
  if (auto problem = read_operator(body, signed_in, start)) return *std::move(problem);
  if (auto problem = read_touching(body, start)) return *std::move(problem);
  if (auto problem = start.kind == RunKind::kCalibration
                         ? read_recipe(body, operation, start)
                         : read_of_verification(body, operation.cell(), start))
    return *std::move(problem);
  if (auto problem = read_temperature(body, operation.clocks().system(), start)) return *std::move(problem);
  if (auto problem = read_warm_up(body, start)) return *std::move(problem);
  if (auto problem = read_stiffness(body, operation.cell(), start)) return *std::move(problem);
  return start;
}

}  // namespace

std::shared_ptr<const StartBody> parse_start(const std::string& text, const std::string& signed_in) try {
  return std::make_shared<const StartBody>(
      StartBody{.json = parse_strict_json("request body", text, kBodyBytesMax), .signed_in = signed_in});
} catch (const ConfigError& error) {
  return std::make_shared<const StartBody>(
      StartBody{.signed_in = signed_in, .problem = wrong(error.pointer(), error.what())});
}

std::variant<std::optional<std::string>, Problem> read_operator_of(const std::string& signed_in,
                                                                   const std::optional<std::string>& named) {
  if (signed_in.empty()) return named;
  if (named && *named != signed_in)
    return wrong("/operator",
                 fmt::format("is '{}', who is signed in, and nobody else; leave it out", signed_in));
  return std::optional(signed_in);
}

const std::string& signed_in_of(const StartBody& body) { return body.signed_in; }

std::variant<StartRequest, Problem> read_start(const StartBody& body, const CellOperation& operation) {
  if (body.problem) return *body.problem;
  return read_body(body.json, body.signed_in, operation);
}

bool is_line(const std::string& text, std::size_t bytes_max) {
  const auto is_control = [](char c) { return static_cast<unsigned char>(c) < 0x20 || c == 0x7f; };
  return !text.empty() && text.size() <= bytes_max && std::ranges::none_of(text, is_control);
}

bool is_operator_name(const std::string& text) { return is_line(text, kOperatorBytesMax); }

std::string operator_name_is() {
  return fmt::format("a name of at most {} bytes without control characters is required", kOperatorBytesMax);
}

std::string operator_of(const StartBody& body) {
  StartRequest start;
  if (!body.json.is_object()) return body.signed_in;
  if (read_operator(body.json, body.signed_in, start)) return {};
  return start.operator_name.value_or("");
}

}  // namespace cell
