#pragma once

#include <string>
#include <vector>

#include "service/documents/limit_table.hpp"
#include "service/report/words/words.hpp"

/// What the table of limits shows, in the report's language; limit_table.hpp has the same in English.
namespace cell {

using CriterionFigures = DecisionRuleDocument::CriterionFigures;

/// "held out mean, plane 3"
std::string criterion_words(const Words& words, const CriterionFigures& criterion, const PlanePlaces& places);

/// figure_beside_limit()
std::string figure_words(const Words& words, const CriterionFigures& criterion,
                         const std::optional<double>& figure);

/// "yes" or "no" of what is so or not.
std::string value_words(const Words& words, const CriterionFigures& criterion);
std::string limit_words(const Words& words, const CriterionFigures& criterion);

/// Why a criterion that fails does: made from its figures.
std::string reason_words(const Words& words, const CriterionFigures& criterion, const PlanePlaces& places);

}  // namespace cell
