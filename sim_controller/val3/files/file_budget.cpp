#include "sim_controller/val3/files/application_reader.hpp"
#include "sim_controller/val3/files/file_rules.hpp"
#include "sim_controller/val3/files/read_application.hpp"

namespace val3 {

std::string FileBudget::name_of(const std::filesystem::path& path) const {
  return path.lexically_relative(top_).generic_string();
}

std::unique_ptr<XmlFile> FileBudget::read(const std::filesystem::path& path, FileFindings& findings) {
  if (files_ >= kFilesMax || bytes_ >= kAllBytesMax) {
    findings.error(files_ >= kFilesMax ? file_rules::kTooManyFiles : file_rules::kFileTooLarge, 0,
                   "the files before this one are as many as are read: " + std::to_string(files_) + ", of " +
                       std::to_string(bytes_) + " bytes");
    return nullptr;
  }
  ++files_;
  auto bytes = read_bounded(path, kFileBytesMax, findings);
  if (!bytes) return nullptr;
  bytes_ += bytes->size();
  return XmlFile::parse(std::move(*bytes), findings);
}

std::optional<std::filesystem::path> FileBudget::listed(const std::filesystem::path& folder,
                                                        const ProjectFile::Listed& file,
                                                        FileFindings& project) {
  auto found = names_.find(folder, file.file);
  if (found) return found;
  bool is_outside = is_absolute_path(file.file);
  for (const std::string& part : path_parts(file.file)) is_outside |= part == "..";
  project.error(is_outside ? file_rules::kFileOutside : file_rules::kFileMissing, file.line,
                shown_word(file.file) + (is_outside ? " is outside of the project" : " is not there"),
                is_outside ? "move it into the project's folder" : "add it, or take it out of the project");
  return std::nullopt;
}

}  // namespace val3
