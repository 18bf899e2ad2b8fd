#pragma once

#include <filesystem>
#include <functional>

#include "service/setup/cell_files.hpp"

/// The directory of a cell that touchcal setup makes.
namespace cell {

/// Whether a cell is there.
bool has_cell(const std::filesystem::path& directory);

/// Where a dialogue that was broken off left its answers; it goes once the cell is made.
std::filesystem::path draft_file(const std::filesystem::path& directory);

/// Names of files in the directory that are not as these say: changed by hand since they were made, or gone.
std::vector<std::string> changed_by_hand(const std::filesystem::path& directory, const CellFiles& files);

/// Called before each operation on the disk with its name: a test fails it, or ends the process there.
using BeforeStep = std::function<void(const char*)>;

/// Writes the files so that others may read them; the cell is the old one or the new one, whole, wherever
/// this ends. A new directory comes by one rename. In one that is there all files are first written into
/// `.setup-new` and made durable; that folder is renamed to kBrokenChangeFolder (read_config.hpp), from then
/// on the new cell holds, and its files are moved into place. A cell with such a folder is not read:
/// complete_change() ends what was broken off. Files of other names stay. Throws std::runtime_error that
/// names the place.
void write_cell_directory(const std::filesystem::path& directory, const CellFiles& files,
                          const BeforeStep& before = {});

/// Moves the files of a change that was broken off into place; whether there was one.
bool complete_change(const std::filesystem::path& directory, const BeforeStep& before = {});

/// Replaces one file whole.
void write_replaced(const std::filesystem::path& file, const std::string& text);

}  // namespace cell
