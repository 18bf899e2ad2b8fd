#pragma once

#include <optional>
#include <string>

#include "config/cell.hpp"
#include "service/documents/conditions_document.hpp"
#include "service/run/run_conditions.hpp"

namespace cell {

/// `conditions` of a run and of a result: temperatures, certificates, versions, operator, digest; null where
/// unknown.
ConditionsDocument conditions_of(const Cell& cell, const Conditions& conditions);
/// The same as text: what is kept with a run.
std::string conditions_document(const Cell& cell, const Conditions& conditions);

/// True if these stored conditions say that a person made the touches.
bool is_guided(const std::optional<std::string>& conditions);

}  // namespace cell
