#pragma once

#include "service/offline_programs/point_expression.hpp"
#include "service/offline_programs/program_warnings.hpp"

namespace cell {

/// Appends the straight lines (`movel`) of a program that end at a filtered point and are off by more than
/// kLineDeviationMaxMm in one of twenty lines of their length, or of a length that cannot be told; and each
/// arc
/// (`movec`) with a filtered point, by the longer of its two chords. The start is where the move before it
/// ends, as long as no block, call or label stands in between.
void append_straight_lines(const ScannedProgram& program, const CarriedPoints& carried,
                           const PointExpressions& expressions, std::vector<ProgramWarning>& warnings);

/// A warning with its file, line and code.
ProgramWarning warning_at(const ScannedProgram& program, std::size_t line, ProgramWarningKind kind);

}  // namespace cell
