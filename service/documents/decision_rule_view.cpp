#include "service/documents/internal/decision_rule_view.hpp"

#include <nlohmann/json.hpp>

#include "service/base/json_figures.hpp"

namespace cell {

Json decision_rule_json(const std::vector<Criterion>& criteria, const AcceptanceLimits& limits) {
  Json list = Json::array();
  for (const Criterion& criterion : criteria) {
    list.push_back({{"name", criterion.name},
                    {"plane", value_or_null(criterion.plane)},
                    {"unit", criterion.unit},
                    {"value", number(criterion.value)},
                    {"limit", criterion.limit},
                    {"expanded_uncertainty", number(criterion.expanded_uncertainty)},
                    {"within_limit", criterion.within_limit()},
                    {"proved", criterion.proved()}});
  }
  return {{"standard", "ISO 14253-1"},
          {"rule", limits.guarded ? "guarded" : "simple"},
          {"text", limits.guarded
                       ? "conformance is accepted where it is proved: value and expanded uncertainty are "
                         "within the limit"
                       : "by agreement in the cell's file a value within its limit is accepted; conformance "
                         "is proved only where value and expanded uncertainty are within the limit"},
          {"coverage_factor", kCoverageFactor},
          {"criteria", list}};
}

}  // namespace cell
