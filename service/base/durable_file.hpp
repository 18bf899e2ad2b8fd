#pragma once

#include <filesystem>
#include <string_view>

namespace cell {

/// Makes the file hold these bytes: all of them or what it held before, whenever the process or the machine
/// ends; durable on return. A new file may be read by its owner only. Throws std::runtime_error that names
/// the file; a file beside it, with ".new" behind its name, may stay then.
void replace_file(const std::filesystem::path& file, std::string_view bytes);

/// What was made, renamed and removed in the directory is so after a loss of power too. Empty: the working
/// directory. Throws std::runtime_error that names it.
void make_directory_durable(const std::filesystem::path& directory);

/// Removes the file, where there is one; durable on return. Throws std::runtime_error that names it.
void remove_file(const std::filesystem::path& file);

}  // namespace cell
