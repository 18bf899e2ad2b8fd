#include <algorithm>

#include "sim_controller/val3/files/application_reader.hpp"
#include "sim_controller/val3/files/data_file.hpp"
#include "sim_controller/val3/files/declared_names.hpp"
#include "sim_controller/val3/files/file_rules.hpp"
#include "sim_controller/val3/files/library_path.hpp"

namespace val3 {
namespace {

/// The data of a type's project, in a vector of its own.
std::vector<Global> data_of_type(FileBudget& files, const std::filesystem::path& folder,
                                 const ProjectFile& project, const DataContext& context,
                                 FileFindings& findings) {
  std::vector<Global> result;
  for (const ProjectFile::Listed& listed : project.data) {
    const auto path = files.listed(folder, listed, findings);
    if (!path) continue;
    FileFindings of_data(files.name_of(*path), findings.all());
    if (const auto xml = files.read(*path, of_data)) read_data_file(*xml, context, of_data, result);
  }
  return result;
}

}  // namespace

void UserTypeReader::read(const ProjectFile& project, FileFindings& findings,
                          std::set<std::filesystem::path>& told) {
  const std::filesystem::path folder = application_.folder;
  told_findings_ = &findings.all();
  DeclaredNames names(project.language);
  for (const ProjectFile::Other& listed : project.types) {
    if (!names.add(listed.name, "type", listed.line, findings)) continue;
    // Two names for one type are two types to the application, as they are to a controller.
    words_.user[listed.name] = add(listed, folder, findings, true);
  }
  const std::size_t listed = states_.size();
  for (std::size_t i = 0; i < listed; ++i) fill(static_cast<int>(i), told);
}

/// A place for the type; its fields come later. `again`: also where the project has a place already.
int UserTypeReader::add(const ProjectFile::Other& listed, const std::filesystem::path& folder,
                        FileFindings& findings, bool again) {
  const LibraryPlace place = find_library(files_.names(), folder, listed.path);
  const bool is_found = place.is == LibraryPlace::Is::kProject;
  if (is_found && !again)
    if (const auto known = by_project_.find(place.file); known != by_project_.end()) return known->second;
  if (!is_found)
    findings.error(
        place.is == LibraryPlace::Is::kOutside ? file_rules::kFileOutside : file_rules::kTypeMissing,
        listed.line, "the type " + listed.name + " at " + shown_word(listed.path) + " is not there",
        "put its project beside this one");
  const auto index = static_cast<int>(states_.size());
  application_.user_types.push_back({.name = listed.name,
                                     .at = {findings.file(), listed.line, 0},
                                     .project = is_found ? files_.name_of(place.file) : std::string{}});
  projects_.push_back(place.file);
  states_.push_back(is_found ? Stand::kListed : Stand::kRead);
  elements_of_user_.push_back(1);
  if (is_found) by_project_.try_emplace(place.file, index);
  return index;
}

void UserTypeReader::fill(int index, std::set<std::filesystem::path>& told) {
  const auto at = static_cast<std::size_t>(index);
  if (states_[at] != Stand::kListed) return;
  states_[at] = Stand::kBeingRead;
  const std::filesystem::path file = projects_[at];
  Findings of_type;
  FileFindings findings(files_.name_of(file), of_type);
  const auto xml = files_.read(file, findings);
  if (const auto project = xml ? read_project_file(*xml, findings) : std::nullopt) {
    const TypeWords words = words_of(*project, file, findings, told);
    fill_fields(index, *project, words, findings);
  }
  states_[at] = Stand::kRead;
  if (told.insert(file).second) told_findings_->insert(told_findings_->end(), of_type.begin(), of_type.end());
}

/// The types that a type's own project lists: filled before its fields, which may be of them.
TypeWords UserTypeReader::words_of(const ProjectFile& project, const std::filesystem::path& file,
                                   FileFindings& findings, std::set<std::filesystem::path>& told) {
  TypeWords words;
  for (const ProjectFile::Other& listed : project.types) {
    const int index = add(listed, file.parent_path(), findings, false);
    if (states_[static_cast<std::size_t>(index)] == Stand::kBeingRead) {
      findings.error(file_rules::kCircularType, listed.line,
                     "the type " + listed.name + " holds itself, by way of its fields",
                     "take it out of Types");
      continue;
    }
    if (++depth_ <= kTypesDeepMax) {
      fill(index, told);
    } else {
      findings.error(file_rules::kNestedTooDeep, listed.line,
                     "types are nested deeper than " + std::to_string(kTypesDeepMax) + " times");
    }
    --depth_;
    words.user[listed.name] = index;
  }
  return words;
}

void UserTypeReader::fill_fields(int index, const ProjectFile& project, const TypeWords& words,
                                 FileFindings& findings) {
  const auto at = static_cast<std::size_t>(index);
  const std::filesystem::path folder = projects_[at].parent_path();
  // Private data are the type's own affair.
  ElementBudget own(kElementsMax);
  std::vector<Global> fields = data_of_type(
      files_, folder, project, {words, application_.user_types, elements_of_user_, own}, findings);
  DeclaredNames names(project.language);
  std::size_t elements = 1;
  for (Global& field : fields) {
    FileFindings of_data(field.declared.file, findings.all());
    if (!names.add(field.declared.name, "variable", field.declared.line, of_data) || !field.is_public)
      continue;
    elements +=
        ElementBudget::of(field.declared.sizes, ElementBudget::of(field.declared.type, elements_of_user_));
    application_.user_types[at].fields.push_back(std::move(field));
  }
  elements_of_user_[at] = std::min(elements, kElementsMax + 1);
}

}  // namespace val3
