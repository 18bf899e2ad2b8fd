#include "service/offline_programs/filter_records.hpp"

#include <algorithm>
#include <vector>

#include "config/config_error.hpp"
#include "config/file_bytes.hpp"
#include "service/base/digest.hpp"

namespace cell {
namespace {

constexpr std::string_view kRecordEnding = ".filtered";

}  // namespace

std::string points_digest(const std::map<std::string, SixNumbers>& elements) {
  std::string text;
  for (const auto& [key, numbers] : elements) {
    std::string line;
    bool is_zero = true;
    for (const double number : numbers) {
      const std::string written = stored_number(number);
      is_zero &= written == "0";
      line += ' ' + written;
    }
    if (!is_zero) text += key + line + '\n';
  }
  return sha256_hex(text);
}

std::filesystem::path filter_record_of(const std::filesystem::path& filtered_file) {
  std::filesystem::path record = filtered_file;
  record += kRecordEnding;
  return record;
}

void add_filter_records(const std::filesystem::path& data_file, FilterList& list) {
  const std::filesystem::path folder = data_file.has_parent_path() ? data_file.parent_path() : ".";
  std::vector<std::filesystem::path> records;
  for (const auto& entry : std::filesystem::directory_iterator(folder))
    if (entry.is_regular_file() && entry.path().extension() == kRecordEnding) records.push_back(entry.path());
  if (records.size() > kFilterRecordsMax)
    throw ConfigError(folder.string(), "",
                      "holds more than " + std::to_string(kFilterRecordsMax) +
                          " records of filtered files; move the data file beside its own ones");
  std::ranges::sort(records);  // so that the same one is named each time
  for (const std::filesystem::path& record : records) {
    const FilterList told = parse_filter_list(record.string(), read_file_bytes(record, kFilterListBytesMax));
    list.filtered.insert(list.filtered.end(), told.filtered.begin(), told.filtered.end());
    list.points.insert(list.points.end(), told.points.begin(), told.points.end());
  }
}

void refuse_filtered_points(const FilterList& list, const std::string& data_source,
                            const std::string& variable, const std::string& digest) {
  const auto found = std::ranges::find(list.points, digest, &FilteredPoints::sha256);
  if (found == list.points.end()) return;
  throw ConfigError(data_source, "",
                    variable + " holds what a filter made" +
                        (found->variable == variable ? "" : " of " + found->variable) + ", says " +
                        found->source +
                        ": a second filter would correct its points twice; give the original, or mark " +
                        variable + " leave");
}

}  // namespace cell
