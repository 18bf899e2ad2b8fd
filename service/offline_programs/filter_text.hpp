#pragma once

#include <string>

#include "service/offline_programs/data_filter.hpp"
#include "service/offline_programs/program_warnings.hpp"

namespace cell {

/// What a person reads of a filtered file: a line a variable with how many values were corrected and how far
/// at most; each value that was warned of or refused, and each attribute that was inserted, with its line;
/// each warning about a program; the notes; the hashes.
std::string filter_text(const FilteredData& data, const ProgramWarnings& programs);

}  // namespace cell
