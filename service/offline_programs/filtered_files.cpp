#include "service/offline_programs/filtered_files.hpp"

#include <stdexcept>

#include "config/file_bytes.hpp"
#include "service/base/durable_file.hpp"
#include "service/offline_programs/filter_records.hpp"

namespace cell {
namespace {

constexpr std::string_view kRecordHead =
    "# touchcal: what a filter made of the points of the file that this is named after; leave it beside that "
    "file, so that they are not corrected twice\n";

/// replace_file() makes files that their owner only may read.
void replace_with_permissions_of(const std::filesystem::path& file, const std::filesystem::path& model,
                                 const std::string& bytes) {
  const auto permissions = std::filesystem::status(model).permissions();
  replace_file(file, bytes);
  std::filesystem::permissions(file, permissions);
}

void demand_other_file(const std::filesystem::path& out, const std::filesystem::path& other,
                       const char* what) {
  std::error_code error;
  if (std::filesystem::equivalent(out, other, error) && !error)
    throw std::invalid_argument(out.string() + " is the " + what +
                                ", which is never written; choose another name");
}

}  // namespace

void demand_free_output(const FilteredFiles& files) {
  const auto status = std::filesystem::status(files.out_file);
  if (!std::filesystem::exists(status)) return;
  demand_other_file(files.out_file, files.data_file, "original");
  demand_other_file(files.out_file, files.list_file, "list");
  if (!std::filesystem::is_regular_file(status))
    throw std::invalid_argument(files.out_file.string() + " is no regular file; choose another name");
  if (!files.overwrite)
    throw std::invalid_argument(files.out_file.string() + " exists; choose another name or give --force");
}

void write_filtered(const FilteredFiles& files, const std::string& list_text, const FilteredData& filtered) {
  demand_free_output(files);
  const std::string marked = with_filtered_mark(list_text, filtered.mark);
  // By its own name, or a link to the list would be replaced instead of the list.
  const std::filesystem::path list = std::filesystem::canonical(files.list_file);
  if (marked != list_text) replace_with_permissions_of(list, list, marked);
  const std::filesystem::path record = filter_record_of(files.out_file);
  const std::string earlier = std::filesystem::exists(record) ? read_file_bytes(record, kFilterListBytesMax)
                                                              : std::string(kRecordHead);
  if (const std::string told = with_filtered_mark(earlier, filtered.mark); told != earlier)
    replace_with_permissions_of(record, files.data_file, told);
  replace_with_permissions_of(files.out_file, files.data_file, filtered.text);
}

}  // namespace cell
