#pragma once

#include <filesystem>
#include <map>
#include <string>

#include "service/offline_programs/filter_list.hpp"
#include "service/offline_programs/number_places.hpp"

/// What a filter made is recognised by its numbers too: a file that an editor has saved anew, or that comes
/// with another list, has other bytes and the same points.
namespace cell {

inline constexpr std::size_t kFilterRecordsMax = 1000;

/// SHA-256 of the elements of one variable, by their keys, as far as the six decimals of a data file go.
/// Elements of zeros do not count: an editor may leave them out.
std::string points_digest(const std::map<std::string, SixNumbers>& elements);

/// The record that stands beside a filtered file: "cell.dtx.filtered", the marks of a list and nothing else.
std::filesystem::path filter_record_of(const std::filesystem::path& filtered_file);

/// Adds what the records in the folder of the data file say. Throws ConfigError where one of them cannot be
/// read, or where there are more than kFilterRecordsMax.
void add_filter_records(const std::filesystem::path& data_file, FilterList& list);

/// Throws ConfigError if the variable holds what a filter made. `digest`: points_digest() of its elements.
void refuse_filtered_points(const FilterList& list, const std::string& data_source,
                            const std::string& variable, const std::string& digest);

}  // namespace cell
