#include "service/store/internal/row_text.hpp"

#include <array>
#include <stdexcept>

namespace cell::row {
namespace {

constexpr std::array kPlanChanges{PlanChange::Kind::kDefer, PlanChange::Kind::kDropFitTouches,
                                  PlanChange::Kind::kSkip, PlanChange::Kind::kBlockToMove,
                                  PlanChange::Kind::kBlockMoved};

std::runtime_error unknown(const char* what, const std::string& name) {
  return std::runtime_error(std::string("the database holds an unknown ") + what + ": '" + name + "'");
}

}  // namespace

std::string place_of(std::string_view table, std::int64_t run_id, std::optional<int> number) {
  std::string place = "table " + std::string(table) + ", run " + std::to_string(run_id);
  return number ? place + ", number " + std::to_string(*number) : place;
}

std::string_view plan_change_name(PlanChange::Kind kind) {
  switch (kind) {
    case PlanChange::Kind::kDefer:
      return "put_off";
    case PlanChange::Kind::kDropFitTouches:
      return "drop_fitted";
    case PlanChange::Kind::kSkip:
      return "skip";
    case PlanChange::Kind::kBlockToMove:
      return "block_to_move";
    case PlanChange::Kind::kBlockMoved:
      return "block_moved";
  }
  return "";
}

PlanChange::Kind plan_change_named(const std::string& name) {
  for (const PlanChange::Kind kind : kPlanChanges)
    if (plan_change_name(kind) == name) return kind;
  throw unknown("change of a plan", name);
}

RunOutcome outcome_named(const std::string& name) {
  if (const auto outcome = run_outcome_named(name)) return *outcome;
  throw unknown("outcome of a run", name);
}

Verdict verdict_named(const std::string& name) {
  if (const auto verdict = cell::verdict_named(name)) return *verdict;
  throw unknown("verdict of a run", name);
}

RunKind kind_named(const std::string& name) {
  if (const auto kind = run_kind_named(name)) return *kind;
  throw unknown("kind of a run", name);
}

}  // namespace cell::row
