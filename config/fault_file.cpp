#include "config/fault_file.hpp"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "calib_core/geometry/units.hpp"
#include "config/config_error.hpp"
#include "config/file_bytes.hpp"
#include "config/json_value.hpp"
#include "config/strict_json.hpp"

namespace cell {
namespace {

using nlohmann::json;

constexpr int kCountMax = 1'000'000;
constexpr int kErrorNumberMax = 100'000;
constexpr int kTimesMax = 1000;
constexpr const char* kLineSource = "control line";

Occurrence read_occurrence(const JsonValue& value) {
  if (value.is_text()) {
    if (value.text() != "every") value.fail("is " + in_quotes(value.text()) + "; give a number or \"every\"");
    return {.every = true};
  }
  return {.nth = value.integer(1, kCountMax)};
}

std::optional<double> find_seconds(const JsonObject& object, const char* key) {
  const auto value = object.find(key);
  if (!value) return std::nullopt;
  return value->number({.min = 0.0, .max = kFaultTimeMaxSeconds * 1e3}) / 1e3;
}

std::optional<int> find_integer(const JsonObject& object, const char* key, int min, int max) {
  const auto value = object.find(key);
  return value ? std::optional(value->integer(min, max)) : std::nullopt;
}

std::optional<std::string> find_text(const JsonObject& object, const char* key) {
  const auto value = object.find(key);
  return value ? std::optional(value->text()) : std::nullopt;
}

DeclaredFault read_fault(const std::string& source, const JsonValue& value) {
  const JsonObject object =
      value.object({"fault", "on", "count", "touch", "phase", "after_ms", "ms", "error", "percent", "times"});
  DeclaredFault fault;
  fault.source = source;
  fault.pointer = value.pointer();
  fault.fault = object.at("fault").text();
  fault.on = find_text(object, "on");
  if (const auto count = object.find("count")) {
    if (!fault.on) count->fail("counts nothing without \"on\"; add it, or remove this");
    fault.count = read_occurrence(*count);
  }
  if (const auto touch = object.find("touch")) {
    if (fault.on) touch->fail("the fault has \"on\" already; keep one of them");
    fault.touch = read_occurrence(*touch);
  }
  if (const auto phase = object.find("phase")) {
    if (!fault.touch) phase->fail("is the phase of no touch; add \"touch\", or remove this");
    fault.phase = phase->text();
  }
  fault.after_s = find_seconds(object, "after_ms");
  fault.duration_s = find_seconds(object, "ms");
  fault.error = find_integer(object, "error", 1, kErrorNumberMax);
  fault.percent = find_integer(object, "percent", 1, 100);
  fault.times = find_integer(object, "times", 1, kTimesMax);
  return fault;
}

OperatorChange read_operator(const JsonValue& value) {
  const JsonObject object = value.object({"powers_up", "touches_probe", "confirms", "frees_arm"});
  const auto find_flag = [&object](const char* key) {
    const auto flag = object.find(key);
    return flag ? std::optional(flag->boolean()) : std::nullopt;
  };
  return {find_flag("powers_up"), find_flag("touches_probe"), find_flag("confirms"), find_flag("frees_arm")};
}

JogOrder read_jog(const JsonValue& value) {
  const JsonObject object = value.object({"joints_deg", "move_mm", "speed_mm_s", "until_touch"});
  JogOrder order;
  const auto joints = object.find("joints_deg"), move = object.find("move_mm");
  if (joints.has_value() == move.has_value()) value.fail("takes joints_deg or move_mm, one of them");
  if (joints) order.joints = joints->numbers<6>() * calib::kRadiansPerDegree;
  if (move) order.move_m = move->numbers<3>() * 1e-3;
  if (const auto speed = object.find("speed_mm_s"))
    order.speed_m_s = speed->number({.min = 0.1, .max = 250.0}) * 1e-3;
  if (const auto until = object.find("until_touch")) order.until_touch = until->boolean();
  return order;
}

std::string line_of(const json& answer) {
  return answer.dump(-1, ' ', false, json::error_handler_t::replace);
}

}  // namespace

void DeclaredFault::fail(std::string_view key, const std::string& message) const {
  throw ConfigError(source, key.empty() ? pointer : pointer + pointer_step(key), message);
}

OperatorDuties changed(OperatorDuties duties, const OperatorChange& change) {
  return {change.powers_up.value_or(duties.powers_up), change.touches_probe.value_or(duties.touches_probe),
          change.confirms.value_or(duties.confirms), change.frees_arm.value_or(duties.frees_arm)};
}

FaultFile read_faults(const std::filesystem::path& file) {
  const std::string source = file.string();
  const json document = read_json_file(file);
  const JsonObject object =
      JsonValue(source, document).document(kFaultsSchema, {"schema", "operator", "faults"});
  FaultFile read;
  if (const auto duties = object.find("operator")) read.duties = changed({}, read_operator(*duties));
  if (const auto faults = object.find("faults")) {
    for (const JsonValue& fault : faults->items(0, kDeclaredFaultsMax)) {
      read.faults.push_back(read_fault(source, fault));
    }
  }
  return read;
}

ControlRequest parse_control_line(std::string_view line) {
  const json document = parse_strict_json(kLineSource, line, kControlLineMax);
  const JsonValue root(kLineSource, document);
  const auto members = root.members();
  const auto has = [&members](const char* key) {
    return std::ranges::any_of(members, [key](const auto& member) { return member.first == key; });
  };
  if (has("operator")) return read_operator(root.object({"operator"}).at("operator"));
  if (has("jog")) return read_jog(root.object({"jog"}).at("jog"));
  if (has("block")) return BlockOrder{root.object({"block"}).at("block").text()};
  if (has("show")) {
    const JsonValue what = root.object({"show"}).at("show");
    if (what.text() != "state") what.fail("is " + in_quotes(what.text()) + "; give \"state\"");
    return ShowState{};
  }
  return read_fault(kLineSource, root);
}

std::string control_answer(const std::vector<ShownValue>& state) {
  json answer{{"ok", true}};
  for (const auto& [key, value] : state) {
    std::visit([&, &name = key](const auto& shown) { answer["state"][name] = shown; }, value);
  }
  return line_of(answer);
}

std::string control_refusal(const std::string& error) { return line_of({{"ok", false}, {"error", error}}); }

}  // namespace cell
