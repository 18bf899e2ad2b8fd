#include "service/documents/limit_table.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <cmath>

namespace cell {
namespace {

using CriterionFigures = DecisionRuleDocument::CriterionFigures;

constexpr int kMillimetreDecimals = 3;
constexpr int kLeastDecimals = 2;  // of a share or a probability
constexpr double kNotSmall = 0.1;  // then it needs no more of them

bool is_whole(double value) { return value == std::floor(value); }

/// Two digits of the limit count, and of a figure that is not small two; the limit has no zero at its end.
int decimals_of(const CriterionFigures& criterion, double shown) {
  if (criterion.unit == "mm") return kMillimetreDecimals;
  const double limit = criterion.limit.value_or(0.0);
  if (limit <= 0.0 || limit >= 1.0) return is_whole(limit) && is_whole(criterion.value.value_or(0.0)) ? 0 : 1;
  if (std::abs(shown) >= kNotSmall) return kLeastDecimals;
  const int decimals = 1 - static_cast<int>(std::floor(std::log10(limit)));
  const double in_tens = limit * std::pow(10.0, decimals - 1);
  const bool is_round = shown == limit && std::abs(in_tens - std::round(in_tens)) < 1e-9;
  return std::max(kLeastDecimals, is_round ? decimals - 1 : decimals);
}

std::string value_text(const CriterionFigures& criterion) {
  if (is_condition(criterion) && criterion.value) return *criterion.value == 1.0 ? "yes" : "no";
  return figure_beside_limit(criterion, criterion.value);
}

std::string limit_text(const CriterionFigures& criterion) {
  if (is_condition(criterion)) return {};
  return (criterion.side == "lower" ? "at least " : "") + figure_beside_limit(criterion, criterion.limit);
}

std::string criterion_text(const CriterionFigures& criterion, const PlanePlaces& places) {
  std::string words = criterion.name.empty() ? "unknown" : criterion.name;
  std::ranges::replace(words, '_', ' ');
  if (criterion.plane) words += ", plane " + plane_text(*criterion.plane, places);
  if (criterion.tool) words += ", " + *criterion.tool;
  return words;
}

}  // namespace

bool is_condition(const CriterionFigures& criterion) {
  return criterion.name == "complete" || criterion.name == "converged";
}

bool fails(const CriterionFigures& criterion, const std::string& rule) {
  return decision_text(criterion, rule).starts_with("FAIL");
}

std::string figure_beside_limit(const CriterionFigures& criterion, std::optional<double> figure) {
  if (!figure) return "unknown";
  const int decimals = decimals_of(criterion, *figure);
  const double last_digit = std::pow(10.0, -decimals);
  const bool is_small = criterion.unit == "1" && *figure > 0.0 && *figure < 0.5 * last_digit;
  const double shown =
      std::abs(*figure) < 0.5 * last_digit ? 0.0 : *figure;  // without the sign of a minus zero
  const std::string text =
      is_small ? fmt::format("< {:.{}f}", last_digit, decimals) : fmt::format("{:.{}f}", shown, decimals);
  return criterion.unit == "1" || criterion.unit.empty() ? text : text + " " + criterion.unit;
}

std::string decision_text(const CriterionFigures& criterion, const std::string& rule) {
  if (!criterion.within_limit) return "unknown";
  if (!*criterion.within_limit) return "FAIL";
  if (criterion.proved.value_or(false)) return "pass (proven)";
  return rule == "guarded" && criterion.proved ? "FAIL (not proven)" : "pass";
}

std::vector<CriterionFigures> by_decision(const DecisionRuleDocument& rule) {
  std::vector<CriterionFigures> ordered = rule.criteria;
  std::ranges::stable_partition(ordered, [&](const CriterionFigures& one) { return fails(one, rule.rule); });
  return ordered;
}

std::vector<LimitRow> limit_rows(const DecisionRuleDocument& rule, const PlanePlaces& places) {
  std::vector<LimitRow> rows;
  for (const CriterionFigures& criterion : by_decision(rule)) {
    rows.push_back(
        {.criterion = criterion_text(criterion, places),
         .decision = decision_text(criterion, rule.rule),
         .value = value_text(criterion),
         .limit = limit_text(criterion),
         .expanded_uncertainty = criterion.expanded_uncertainty
                                     ? figure_beside_limit(criterion, criterion.expanded_uncertainty)
                                     : std::string()});
  }
  return rows;
}

}  // namespace cell
