#include "sim_controller/val3/checks/rules.hpp"

#include <algorithm>
#include <vector>

#include "sim_controller/val3/checks/rule_tables.hpp"

namespace val3 {
namespace {

std::vector<Rule> sorted_rules() {
  std::vector<Rule> all;
  for (const auto rules :
       {rule_tables::of_files(), rule_tables::of_text(), rule_tables::of_names(), rule_tables::of_checks()})
    all.insert(all.end(), rules.begin(), rules.end());
  std::ranges::sort(all, {}, &Rule::id);
  return all;
}

}  // namespace

std::span<const Rule> all_rules() {
  static const std::vector<Rule> rules = sorted_rules();
  return rules;
}

const Rule* find_rule(std::string_view id) {
  const auto rules = all_rules();
  const auto found = std::ranges::lower_bound(rules, id, {}, &Rule::id);
  return found != rules.end() && found->id == id ? &*found : nullptr;
}

}  // namespace val3
