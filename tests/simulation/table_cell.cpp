#include "tests/simulation/table_cell.hpp"

#include <spdlog/fmt/fmt.h>
#include <spdlog/fmt/ranges.h>

#include <algorithm>
#include <array>
#include <stdexcept>

#include "tests/simulation/person.hpp"

namespace simulation {
namespace {

using namespace std::chrono_literals;
using cell::State;

/// Any other one is as good; all cells have the same.
constexpr std::uint64_t kSeedOfTable = 1;
/// An arm that is stopped has stopped by then.
constexpr Time kBrakes = 1s;

Scenario scenario_of(const TableStep& step, const std::vector<DrawnFault>& faults) {
  Scenario scenario{
      .seed = kSeedOfTable, .touch_count = kTouchesMin, .speed = kQuickSpeed, .script = step.script};
  auto& last = scenario.script.back().then;
  last.insert(last.end(), faults.begin(), faults.end());
  return scenario;
}

Outcome run_to_step(const TableStep& step, const Scenario& scenario) {
  Outcome outcome = run_world(scenario);
  if (!outcome.record.rest.struck_at)
    throw std::logic_error(fmt::format("the step '{}' is not reached: '{}' was not seen\n{}", step.name,
                                       step.sight(), outcome.journal));
  return outcome;
}

/// "host: touch 3" and "controller: touch_result of touch 3" are of a touch and a touch_result.
bool is_of(std::string_view sight, std::string_view message) {
  const std::size_t at = sight.find(": ");
  if (at == std::string_view::npos) return false;
  const std::string_view text = sight.substr(at + 2);
  return text.substr(0, text.find(' ')) == message;
}

bool is_next(const TableStep& step, const RestRecord& around, std::string_view message) {
  // What the host has just sent the controller has not taken yet.
  if (step.sight().starts_with("host: ") && is_of(step.sight(), message)) return true;
  return std::ranges::any_of(around.next_messages,
                             [&](const std::string& sight) { return is_of(sight, message); });
}

bool can_happen(const TableMode& mode, const TableStep& step, const RestRecord& around) {
  switch (mode.needs) {
    case Needs::kNothing:
      return true;
    case Needs::kMessage:
      return is_next(step, around, message_of(mode));
    case Needs::kMotionCommand:
      return around.was_commanded;
    case Needs::kWrite:
      return around.next_writes > 0;
  }
  return true;
}

// ---- the words ----

std::string rests_text(const RestRecord& rest) {
  if (!rest.at) return "does not come to rest";
  std::string text(cell::state_name(rest.state));
  if (rest.waiting_for) text += ", asks for " + *rest.waiting_for;
  return text;
}

std::string shown_text(const RestRecord& rest) {
  return rest.fault ? std::string(cell::describe(*rest.fault).name) : "";
}

std::string told_text(const RestRecord& rest) {
  std::vector<std::string> told = rest.told;
  std::erase(told, "fault " + shown_text(rest));
  for (std::string& one : told)
    if (one.starts_with("fault ")) one = fmt::format("`{}`", one.substr(std::string_view("fault ").size()));
  return fmt::format("{}", fmt::join(told, ", "));
}

std::string arm_text(const RestRecord& rest) {
  const std::string_view place = rest.is_clear ? "clear" : "way back due";
  if (!rest.last_moved_at) return fmt::format("did not move, {}", place);
  if (*rest.last_moved_at - *rest.struck_at <= kBrakes) return fmt::format("stopped, {}", place);
  return fmt::format("moved on, then stood {}", place);
}

std::string person_text(const std::vector<cell::Command>& did) {
  std::vector<std::string_view> names;
  for (const cell::Command command : did) names.push_back(cell::command_name(command));
  return fmt::format("{}", fmt::join(names, ", "));
}

std::string end_text(const Record& record) {
  std::string text(cell::state_name(record.states.back().state));
  for (const RunRecord& run : record.stores.back().runs)
    text += fmt::format(", run {} {}", run.run.id, cell::run_outcome_name(run.run.outcome));
  return text;
}

// ---- what must not be ----

bool says(std::string_view text, std::string_view part) { return text.find(part) != std::string_view::npos; }

/// The step, or the command behind it that was the last one before the code was told.
Time what_it_speaks_of(const Record& record) {
  Time since = *record.rest.struck_at;
  for (const MotionSent& motion : record.motions)
    if (motion.at <= record.rest.told_at) since = std::max(since, motion.at);
  return since;
}

/// By more than what was not looked at yet when the command was sent.
bool moved_since(const Record& record, Time since) {
  constexpr Time kBetweenTwoLooks = 50ms;
  return record.rest.last_moved_at && *record.rest.last_moved_at > since + kBetweenTwoLooks;
}

/// Against what the arm did between the step and the rest.
std::optional<std::string> wrong_action(const Record& record) {
  const RestRecord& rest = record.rest;
  const std::string_view action = cell::describe(*rest.fault).robot_action;
  const auto wrong = [&](std::string_view what) {
    return fmt::format("`{}` says \"{}\", and {}", shown_text(rest), action, what);
  };
  const bool is_new = std::ranges::find(rest.told, "fault " + shown_text(rest)) != rest.told.end();
  if (!is_new) return std::nullopt;  // it says what was before the step
  if (says(action, "nothing moved") && moved_since(record, what_it_speaks_of(record)))
    return wrong("the arm moved");
  if (says(action, "clear of the face") && !rest.is_clear) return wrong("a way back from a face is due");
  if (says(action, "retracted") && !rest.is_clear) return wrong("a way back from a face is due");
  const bool says_stands = says(action, "stands where it was") || says(action, "stands there");
  if (says_stands && rest.last_moved_at && *rest.last_moved_at > rest.told_at + kBrakes)
    return wrong("it moved more than a second later");
  return std::nullopt;
}

std::optional<std::string> wrong_words(const RestRecord& rest) {
  if (rest.state != State::kHeld && rest.state != State::kStopped && rest.state != State::kAborted)
    return std::nullopt;
  const auto named = commands_named(cell::describe(*rest.fault).next_step);
  const bool is_one_taken = std::ranges::any_of(
      named, [&](cell::Command one) { return std::ranges::find(rest.exits, one) != rest.exits.end(); });
  if (is_one_taken) return std::nullopt;
  return fmt::format("the next step of `{}` names no command that {} takes", shown_text(rest),
                     cell::state_name(rest.state));
}

bool is_complete(const RunRecord& run) { return run.run.outcome == cell::RunOutcome::kComplete; }

std::set<std::string> codes_of(const RestRecord& rest) {
  std::set<std::string> codes;
  for (const std::string& told : rest.told)
    if (const std::size_t at = told.find(' '); at != std::string::npos) codes.insert(told.substr(at + 1));
  if (rest.fault) codes.insert(shown_text(rest));
  return codes;
}

}  // namespace

std::vector<std::string> contradictions_of(const TableMode& mode, const RestRecord& around,
                                           const Outcome& outcome) {
  std::vector<std::string> found = outcome.broken;
  const RestRecord& rest = outcome.record.rest;
  const auto add = [&found](std::optional<std::string> what) {
    if (what) found.push_back(std::move(*what));
  };
  if (!rest.at) {
    found.emplace_back("it does not come to rest");
  } else if (rest.fault) {
    add(wrong_action(outcome.record));
    add(wrong_words(rest));
  } else if (rest.state != around.state && mode.group != "clients" && rest.told.empty() &&
             (rest.state == State::kHeld || rest.state == State::kStopped || rest.state == State::kAborted)) {
    found.push_back(fmt::format("{} without a reason", cell::state_name(rest.state)));
  }
  const auto& stores = outcome.record.stores;
  if (!stores.empty() && std::ranges::none_of(stores.back().runs, is_complete))
    found.emplace_back("who does what he is told comes to no complete run");
  return found;
}

Scenario scenario_of(const TableMode& mode, const TableStep& step) { return scenario_of(step, mode.faults); }

RestRecord undisturbed(const TableStep& step) { return run_to_step(step, scenario_of(step, {})).record.rest; }

TriedCell try_cell(const TableMode& mode, const TableStep& step, const RestRecord& around) {
  if (!can_happen(mode, step, around))
    return {.cell = {.cannot_happen = std::string(reason_of(mode.needs))}, .contradictions = {}, .codes = {}};
  const Outcome outcome = run_to_step(step, scenario_of(mode, step));
  const RestRecord& rest = outcome.record.rest;
  return {.cell = {.cannot_happen = {},
                   .rests = rests_text(rest),
                   .shown = shown_text(rest),
                   .told = told_text(rest),
                   .arm = arm_text(rest),
                   .person = person_text(outcome.record.person_did),
                   .end = end_text(outcome.record)},
          .contradictions = contradictions_of(mode, around, outcome),
          .codes = codes_of(rest)};
}

}  // namespace simulation
