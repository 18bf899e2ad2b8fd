#include "sim_controller/val3/files/application_reader.hpp"

#include <algorithm>

#include "sim_controller/val3/files/built_in_io.hpp"
#include "sim_controller/val3/files/data_file.hpp"
#include "sim_controller/val3/files/declaration_checks.hpp"
#include "sim_controller/val3/files/declared_names.hpp"
#include "sim_controller/val3/files/file_rules.hpp"
#include "sim_controller/val3/files/library_path.hpp"
#include "sim_controller/val3/files/program_file.hpp"
#include "sim_controller/val3/files/read_application.hpp"

namespace val3 {
namespace {

/// The library that every application of s5 and s6 has: the controller's inputs and outputs.
bool is_built_in(std::string_view path) {
  const auto parts = path_parts(path);
  return !parts.empty() && (in_lower_case(parts.back()) == "io" || in_lower_case(parts.back()) == "io.pjx");
}

/// Files of a section, without those that are listed twice.
std::vector<ProjectFile::Listed> without_twins(const std::vector<ProjectFile::Listed>& listed,
                                               FileFindings& findings) {
  std::vector<ProjectFile::Listed> result;
  std::set<std::string> seen;
  for (const ProjectFile::Listed& one : listed) {
    if (seen.insert(in_lower_case(one.file)).second)
      result.push_back(one);
    else
      findings.error(file_rules::kDuplicateName, one.line,
                     "the file " + shown_word(one.file) + " is listed twice", "remove one of them");
  }
  return result;
}

}  // namespace

std::shared_ptr<Application> ApplicationReader::read(const std::filesystem::path& file, int depth) {
  if (const auto known = read_.find(file); known != read_.end()) return known->second;
  FileFindings findings(files_.name_of(file), findings_);
  const auto xml = files_.read(file, findings);
  const auto project = xml ? read_project_file(*xml, findings) : std::nullopt;
  if (!project) return read_[file] = nullptr;
  being_read_.insert(file);
  auto application = std::make_shared<Application>();
  application->name = file.stem().string();
  application->folder = file.parent_path().string();
  application->project = file.filename().string();
  application->version = project->version;
  application->language = project->language;
  application->form = project->form;
  application->stack_bytes = project->stack_bytes;
  application->is_metric = project->is_metric;

  application->has_pages = files_.names().find(application->folder, "interface").has_value();

  UserTypeReader types(files_, *application);
  types.read(*project, findings, types_told_);
  read_data(*application, *project, types, findings);
  read_programs(*application, *project, types, findings);
  note_unlisted(*project, file.parent_path(), findings);
  read_libraries(*application, *project, findings, depth);
  read_loadable(*application, depth);
  check_fathers(*application, findings_);
  being_read_.erase(file);
  return read_[file] = application;
}

void ApplicationReader::read_data(Application& application, const ProjectFile& project,
                                  const UserTypeReader& types, FileFindings& findings) {
  const DataContext context{types.words(), application.user_types, types.elements_of_user(), elements_};
  DeclaredNames names(application.language);
  for (const ProjectFile::Listed& listed : without_twins(project.data, findings)) {
    const auto path = files_.listed(application.folder, listed, findings);
    application.has_unread_data = application.has_unread_data || !path;
    if (!path) continue;
    FileFindings of_data(files_.name_of(*path), findings_);
    const auto xml = files_.read(*path, of_data);
    application.has_unread_data = application.has_unread_data || !xml;
    if (!xml) continue;
    std::vector<Global> globals;
    const std::size_t before = findings_.size();
    read_data_file(*xml, context, of_data, globals);
    application.has_unread_data =
        application.has_unread_data ||
        std::any_of(findings_.begin() + static_cast<std::ptrdiff_t>(before), findings_.end(),
                    [](const Finding& one) { return one.rule == file_rules::kUnknownType; });
    for (Global& global : globals)
      if (names.add(global.declared.name, "variable", global.declared.line, of_data))
        application.globals.push_back(std::move(global));
  }
}

void ApplicationReader::read_programs(Application& application, const ProjectFile& project,
                                      const UserTypeReader& types, FileFindings& findings) {
  const ProgramContext context{types.words(), types.elements_of_user(), application.language};
  DeclaredNames names(application.language);
  for (const ProjectFile::Listed& listed : without_twins(project.programs, findings)) {
    const auto path = files_.listed(application.folder, listed, findings);
    const std::string stem = in_lower_case(std::filesystem::path(listed.file).stem().string());
    if (!path) {
      application.unread_programs.push_back(stem);
      continue;
    }
    FileFindings of_program(files_.name_of(*path), findings_);
    const auto xml = files_.read(*path, of_program);
    std::vector<Program> programs;
    if (xml) read_program_file(*xml, context, of_program, programs);
    if (programs.empty()) application.unread_programs.push_back(stem);
    if (programs.size() == 1 && in_lower_case(path->stem().string()) != in_lower_case(programs[0].name))
      of_program.note(file_rules::kFileName, programs[0].line,
                      "the program of this file is called " + shown_word(programs[0].name),
                      "call the file by the program's name");
    for (Program& program : programs)
      if (names.add(program.name, "program", program.line, of_program))
        application.programs.push_back(std::move(program));
  }
}

void ApplicationReader::note_unlisted(const ProjectFile& project, const std::filesystem::path& folder,
                                      FileFindings& findings) {
  std::set<std::string> listed;
  for (const ProjectFile::Listed& one : project.programs) {
    const auto parts = path_parts(one.file);
    if (parts.size() == 1) listed.insert(in_lower_case(parts[0]));
  }
  for (const std::string& name : files_.names().names_in(folder)) {
    const std::string lower = in_lower_case(name);
    if (lower.ends_with(".pgx") && !listed.contains(lower))
      findings.note(file_rules::kUnlistedProgram, 0, "the project does not list " + shown_word(name),
                    "list it, or remove it");
  }
}

void ApplicationReader::read_libraries(Application& application, const ProjectFile& project,
                                       FileFindings& findings, int depth) {
  DeclaredNames aliases(application.language);
  for (const ProjectFile::Other& listed : project.libraries) {
    if (!aliases.add(listed.name, "library", listed.line, findings)) continue;
    Library library{.alias = listed.name,
                    .path = listed.path,
                    .autoload = listed.autoload,
                    .at = {findings.file(), listed.line, 0},
                    .application = nullptr,
                    .loadable = {}};
    if (!listed.path.empty())
      library.application =
          read_library(application.folder, listed, Severity::kWarning, findings, depth).application;
    application.libraries.push_back(std::move(library));
  }
  if (application.form == 5 && application.name != "io") read_io(application, findings.file());
}

/// Every application of s5 and s6 has the library io, whether its project says so or not.
void ApplicationReader::read_io(Application& application, const std::string& project) {
  int index = application.library_named("io");
  if (index < 0) {
    index = static_cast<int>(application.libraries.size());
    application.libraries.push_back(
        {.alias = "io", .path = "io", .autoload = true, .at = {project, 0, 0}, .application = nullptr});
  }
  Library& io = application.libraries[static_cast<std::size_t>(index)];
  if (io.application)
    link_to_signals(*io.application);
  else if (is_built_in(io.path))
    io.application = built_in_io(application);
}

void ApplicationReader::read_loadable(Application& application, int depth) {
  for (const Program& program : application.programs)
    for (const Line& line : program.lines)
      for (const Expression& e : line.expressions) add_loadable(application, program, e, depth);
}

void ApplicationReader::add_loadable(Application& application, const Program& program, const Expression& e,
                                     int depth) {
  for (const Expression& part : e.parts) add_loadable(application, program, part, depth);
  const bool is_load = e.kind == Expression::Kind::kCall && e.text == "libLoad" && !e.parts.empty() &&
                       e.parts[0].kind == Expression::Kind::kText;
  const int index = is_load ? application.library_named(e.alias) : -1;
  if (index < 0) return;
  Library& library = application.libraries[static_cast<std::size_t>(index)];
  const std::string& path = e.parts[0].text;
  if (std::ranges::find(library.loadable, path, &Loadable::path) != library.loadable.end()) return;
  FileFindings of_program(program.file, findings_);
  // libLoad tells the program when it finds nothing: that is no mistake in itself.
  Loadable found =
      read_library(application.folder, {e.alias, path, false, e.line}, Severity::kNote, of_program, depth);
  library.loadable.push_back(std::move(found));
}

Loadable ApplicationReader::read_library(const std::filesystem::path& folder,
                                         const ProjectFile::Other& listed, Severity missing,
                                         FileFindings& findings, int depth) {
  const LibraryPlace place = find_library(files_.names(), folder, listed.path);
  const std::string called = "the library " + listed.name + " at " + shown_word(listed.path);
  Loadable found{.path = listed.path, .is = Loadable::Is::kMissing, .application = nullptr};
  switch (place.is) {
    case LibraryPlace::Is::kMissing:
      if (!is_built_in(listed.path))
        findings.tell(missing, file_rules::kLibraryMissing, listed.line,
                      called + " is not there: nothing of it is checked", "put its folder beside this one");
      return found;
    case LibraryPlace::Is::kOutside:
      found.is = Loadable::Is::kOutside;
      findings.error(file_rules::kFileOutside, listed.line,
                     called + " is outside of the user's applications");
      return found;
    case LibraryPlace::Is::kEncrypted:
      found.is = Loadable::Is::kEncrypted;
      findings.warning(file_rules::kLibraryEncrypted, listed.line,
                       called + " is encrypted: nothing of it is checked");
      return found;
    case LibraryPlace::Is::kProject:
      break;
  }
  found.is = Loadable::Is::kUnreadable;
  if (being_read_.contains(place.file)) {
    findings.error(file_rules::kCircularLibrary, listed.line, called + " uses this project in its turn",
                   "libraries must not use each other in a circle");
  } else if (depth >= kLibrariesDeepMax) {
    findings.error(file_rules::kLibrariesTooDeep, listed.line,
                   called + " is nested deeper than " + std::to_string(kLibrariesDeepMax) + " libraries");
  } else if ((found.application = read(place.file, depth + 1))) {
    found.is = Loadable::Is::kFound;
  }
  return found;
}

}  // namespace val3
