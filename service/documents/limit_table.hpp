#pragma once

#include <optional>
#include <string>
#include <vector>

#include "service/documents/plane_places.hpp"
#include "service/documents/result_document.hpp"

namespace cell {

/// A figure of a criterion as it is read beside its limit: millimetres with three decimals, a share or a
/// probability with two, and where it is small with those at which two digits of the limit count ("< 0.001"
/// where it is less than half of the last one), a count with none; with its unit. "unknown" where it is
/// absent.
std::string figure_beside_limit(const DecisionRuleDocument::CriterionFigures& criterion,
                                std::optional<double> figure);

/// What became of a criterion: "pass", "pass (proven)", "FAIL", and with a guarded rule "FAIL (not proven)"
/// for what is within its limit and not proven; "unknown" where the document does not say.
std::string decision_text(const DecisionRuleDocument::CriterionFigures& criterion, const std::string& rule);

/// Whether a criterion is what is so or not: its value is 1 or 0, without a limit.
bool is_condition(const DecisionRuleDocument::CriterionFigures& criterion);

/// Whether it rejects by the rule.
bool fails(const DecisionRuleDocument::CriterionFigures& criterion, const std::string& rule);

/// The criteria of a rule; what rejects comes first.
std::vector<DecisionRuleDocument::CriterionFigures> by_decision(const DecisionRuleDocument& rule);

/// A criterion as people read it.
struct LimitRow {
  std::string criterion;  // "held out mean, plane 3", "held out mean, plane 8 (stand)"
  std::string decision;   // decision_text()
  std::string value;      // of what is so or not: "yes" or "no", without a limit
  std::string limit;
  std::string expanded_uncertainty;  // empty where it is not known
  bool operator==(const LimitRow&) const = default;
};

/// A row a criterion; what rejects comes first.
std::vector<LimitRow> limit_rows(const DecisionRuleDocument& rule, const PlanePlaces& places = {});

}  // namespace cell
