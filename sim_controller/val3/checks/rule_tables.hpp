#pragma once

#include <span>

#include "sim_controller/val3/checks/rules.hpp"

/// The table of rules, by the part that finds them. M5 and M6 are the VAL3 manuals of versions 5.3 and 6.
namespace val3::rule_tables {

std::span<const Rule> of_files();
std::span<const Rule> of_text();
std::span<const Rule> of_names();
std::span<const Rule> of_checks();

}  // namespace val3::rule_tables
