#include "service/offline_programs/program_folder.hpp"

#include <algorithm>
#include <optional>

#include "config/config_error.hpp"
#include "config/file_bytes.hpp"

namespace cell {
namespace {

constexpr double kMmPerInch = 25.4;

std::string lower_extension(const std::filesystem::path& file) {
  std::string extension = file.extension().string();
  for (char& c : extension)
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  return extension;
}

/// Regular files only: a pipe or a device would have no end.
std::vector<std::filesystem::path> val3_files_in(const std::filesystem::path& folder) {
  std::vector<std::filesystem::path> files;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    const std::string extension = lower_extension(entry.path());
    if (entry.is_regular_file() && (extension == ".pgx" || extension == ".pjx"))
      files.push_back(entry.path());
  }
  if (files.size() > kProgramFilesMax)
    throw ConfigError(folder.string(), "",
                      "holds more than " + std::to_string(kProgramFilesMax) +
                          " programs; move the data file beside its own ones");
  std::ranges::sort(files);
  return files;
}

}  // namespace

double mm_per_unit_of_project(const XmlText& project) {
  pugi::xml_node parameters = element_named(project.root(), "Parameters");
  if (!parameters) parameters = element_named(project.root(), "parameters");
  const std::string is_metric = parameters.attribute("millimeterUnit").as_string("true");
  if (is_metric == "true" || is_metric == "1") return 1.0;
  if (is_metric == "false" || is_metric == "0") return kMmPerInch;
  project.fail(parameters, "millimeterUnit is " + in_quotes(is_metric) + "; write true or false");
}

ProgramFolder read_program_folder(const std::filesystem::path& data_file) {
  const std::filesystem::path folder = data_file.has_parent_path() ? data_file.parent_path() : ".";
  ProgramFolder result;
  std::optional<double> mm_per_unit;
  std::size_t bytes_read = 0;
  for (const std::filesystem::path& file : val3_files_in(folder)) {
    const std::string name = file.filename().string();
    std::string bytes;
    try {
      bytes = read_file_bytes(file, kVal3FileBytesMax);
    } catch (const ConfigError& error) {
      result.notes.emplace_back(error.what());
      continue;
    }
    bytes_read += bytes.size();
    if (bytes_read > kProgramBytesMax)
      throw ConfigError(folder.string(), "",
                        "holds programs of more than " + std::to_string(kProgramBytesMax) +
                            " bytes; move the data file beside its own ones");
    if (lower_extension(file) == ".pgx") {
      result.programs.push_back({name, std::move(bytes)});
      continue;
    }
    const double unit = mm_per_unit_of_project(XmlText(name, std::move(bytes)));
    if (mm_per_unit && *mm_per_unit != unit)
      throw ConfigError(file.string(), "",
                        "counts in another unit than the project beside it; leave one of them in the folder");
    mm_per_unit = unit;
  }
  if (!mm_per_unit) result.notes.push_back("no project (.pjx) beside the data file: lengths are taken as mm");
  result.mm_per_unit = mm_per_unit.value_or(1.0);
  return result;
}

}  // namespace cell
