#pragma once

#include <filesystem>

#include "service/setup/cell_files.hpp"

/// The directory of a cell that touchcal setup makes.
namespace cell {

/// Whether a cell is there.
bool has_cell(const std::filesystem::path& directory);

/// Where a dialogue that was broken off left its answers; it goes once the cell is made.
std::filesystem::path draft_file(const std::filesystem::path& directory);

/// Names of files in the directory that are not as these say: changed by hand since they were made, or gone.
std::vector<std::string> changed_by_hand(const std::filesystem::path& directory, const CellFiles& files);

/// Writes the files so that others may read them. A new directory comes whole or not at all; in one that is
/// there each file is replaced whole, the cell's own last. Throws std::runtime_error that names the place.
void write_cell_directory(const std::filesystem::path& directory, const CellFiles& files);

/// Replaces one file whole.
void write_replaced(const std::filesystem::path& file, const std::string& text);

}  // namespace cell
