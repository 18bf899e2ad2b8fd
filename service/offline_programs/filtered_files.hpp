#pragma once

#include <filesystem>
#include <string>

#include "service/offline_programs/data_filter.hpp"

namespace cell {

struct FilteredFiles {
  std::filesystem::path data_file;  // the original, which is never written
  std::filesystem::path list_file;
  std::filesystem::path out_file;
  bool overwrite = false;  // the file that is there as out_file
};

/// Throws std::invalid_argument, with what to do, if out_file is the original or the list by any of its names
/// (links too), is there and must not be overwritten, or is no regular file.
void demand_free_output(const FilteredFiles& files);

/// Marks the list and the record beside out_file (filter_record_of()), then writes out_file: each of them
/// whole or as it was, whenever the process or the machine ends. The marks come first: a filtered file that
/// no list knows could be filtered twice, while a mark without its file harms nothing. `list_text`: the list
/// as it was read. The new file may be read by whoever may read the original. Throws what
/// demand_free_output() throws, and std::runtime_error that names the file it could not write.
void write_filtered(const FilteredFiles& files, const std::string& list_text, const FilteredData& filtered);

}  // namespace cell
