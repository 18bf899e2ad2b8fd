#include "sim_controller/val3/files/read_application.hpp"

#include "sim_controller/val3/files/application_reader.hpp"
#include "sim_controller/val3/files/declaration_checks.hpp"
#include "sim_controller/val3/files/file_rules.hpp"

namespace val3 {
namespace {

/// The project of a folder: the one of its name, or the only one. Otherwise why there is none.
struct FoundProject {
  std::filesystem::path file;
  std::string problem;
};

FoundProject project_of(const std::filesystem::path& folder) {
  FolderNames names;
  std::vector<std::string> projects;
  for (const std::string& name : names.names_in(folder))
    if (in_lower_case(name).ends_with(".pjx")) projects.push_back(name);
  for (const std::string& name : projects)
    if (in_lower_case(name) == in_lower_case(folder.filename().string()) + ".pjx") return {folder / name, {}};
  if (projects.size() == 1) return {folder / projects[0], {}};
  if (projects.empty()) return {{}, "the folder holds no project (.pjx)"};
  return {{}, "the folder holds " + std::to_string(projects.size()) + " projects, and none of its name"};
}

}  // namespace

ReadApplication read_application(const std::filesystem::path& project_or_folder) {
  ReadApplication result;
  std::error_code error;
  std::filesystem::path file = std::filesystem::weakly_canonical(project_or_folder, error);
  if (error) file = project_or_folder.lexically_normal();
  const auto refuse = [&result, &file](std::string what, std::string remedy) {
    FileFindings(file.filename().string(), result.findings)
        .error(file_rules::kNoProject, 0, std::move(what), std::move(remedy));
  };
  if (std::filesystem::is_directory(file, error)) {
    const FoundProject found = project_of(file);
    if (found.file.empty()) {
      refuse(found.problem, "name the project's file (.pjx)");
      return result;
    }
    file = found.file;
  } else if (!std::filesystem::exists(file, error)) {
    refuse("there is no such file or folder", "name the project's file (.pjx) or its folder");
    return result;
  }
  ApplicationReader reader(file.parent_path(), result.findings);
  const auto application = reader.read(file, 0);
  if (!application) return result;
  result.application = std::move(*application);
  check_start_and_stop(result.application, result.findings);
  return result;
}

}  // namespace val3
