#pragma once

#include <optional>
#include <set>
#include <string>
#include <vector>

#include "tests/simulation/table_modes.hpp"
#include "tests/simulation/table_steps.hpp"
#include "tests/simulation/world.hpp"

namespace simulation {

/// What a cell of the fault table says, in the document's words. All of it is what a world did.
struct TableCell {
  /// Why the mode cannot happen at this step; then all else is empty.
  std::string cannot_happen;
  std::string rests;   // "HELD", "STARTING, asks for confirm"
  std::string shown;   // the fault's code at rest
  std::string told;    // faults, warnings and refusals on the way there
  std::string arm;     // "stopped at the face"
  std::string person;  // the commands that he gave by the next step's words
  std::string end;     // "COMPLETE: run 1 complete"
  bool operator==(const TableCell&) const = default;
};

/// With what was found beside it.
struct TriedCell {
  TableCell cell;
  /// Places in which the product contradicts itself, a sentence each.
  std::vector<std::string> contradictions;
  std::set<std::string> codes;  // that were shown or told
};

/// The step's own world: what comes next there, by which modes that cannot happen are told.
RestRecord undisturbed(const TableStep& step);

/// `around` is undisturbed() of the step.
TriedCell try_cell(const TableMode& mode, const TableStep& step, const RestRecord& around);

/// Where what a world told does not fit what happened in it.
std::vector<std::string> contradictions_of(const TableMode& mode, const RestRecord& around,
                                           const Outcome& outcome);

Scenario scenario_of(const TableMode& mode, const TableStep& step);

}  // namespace simulation
