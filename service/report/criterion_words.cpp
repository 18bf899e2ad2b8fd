#include "service/report/internal/criterion_words.hpp"

#include <algorithm>

namespace cell {

std::string criterion_words(const Words& words, const CriterionFigures& criterion,
                            const PlanePlaces& places) {
  std::string name = criterion.name.empty() ? "unknown" : criterion.name;
  std::ranges::replace(name, '_', ' ');
  std::string told = words(name);
  if (criterion.plane) told += words(", plane {}", plane_text(*criterion.plane, places));
  if (criterion.tool) told += ", " + *criterion.tool;
  return told;
}

std::string figure_words(const Words& words, const CriterionFigures& criterion,
                         const std::optional<double>& figure) {
  return figure ? words.number(figure_beside_limit(criterion, figure)) : words("unknown");
}

std::string value_words(const Words& words, const CriterionFigures& criterion) {
  if (is_condition(criterion) && criterion.value) return words(*criterion.value == 1.0 ? "yes" : "no");
  return figure_words(words, criterion, criterion.value);
}

std::string limit_words(const Words& words, const CriterionFigures& criterion) {
  if (is_condition(criterion)) return {};
  const std::string limit = figure_words(words, criterion, criterion.limit);
  return criterion.side == "lower" ? words("at least {}", limit) : limit;
}

std::string reason_words(const Words& words, const CriterionFigures& criterion, const PlanePlaces& places) {
  const std::string what = criterion_words(words, criterion, places);
  const std::string value = value_words(words, criterion);
  if (is_condition(criterion)) return words("{}: {}", what, value);
  const std::string limit = limit_words(words, criterion);
  if (criterion.value && criterion.within_limit.value_or(false))
    return words("{}: {} ± {}, not surely within {}", what, value,
                 figure_words(words, criterion, criterion.expanded_uncertainty), limit);
  return words("{}: {}, the limit is {}", what, value, limit);
}

}  // namespace cell
