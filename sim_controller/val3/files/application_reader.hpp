#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include "sim_controller/val3/files/folder_names.hpp"
#include "sim_controller/val3/files/project_file.hpp"
#include "sim_controller/val3/files/type_words.hpp"
#include "sim_controller/val3/files/xml_file.hpp"
#include "sim_controller/val3/program/application.hpp"

namespace val3 {

/// Reads files while their number and bytes stay within limits, each by the name that findings give it.
class FileBudget {
 public:
  /// `top`: the folder that names are relative to.
  explicit FileBudget(std::filesystem::path top) : top_(std::move(top)) {}
  /// Null when it cannot be read, or is no XML.
  std::unique_ptr<XmlFile> read(const std::filesystem::path& path, FileFindings& findings);
  /// From the top folder, with /.
  [[nodiscard]] std::string name_of(const std::filesystem::path& path) const;
  /// The file that a project lists, found without regard to case; empty, and found at the project's line,
  /// when it is not there or leaves the project's folder.
  std::optional<std::filesystem::path> listed(const std::filesystem::path& folder,
                                              const ProjectFile::Listed& file, FileFindings& project);
  FolderNames& names() { return names_; }

 private:
  std::filesystem::path top_;
  FolderNames names_;
  std::size_t files_ = 0;
  std::size_t bytes_ = 0;
};

/// All files together: more is no application that a controller holds.
inline constexpr std::size_t kAllBytesMax = 64U << 20U;

inline constexpr int kTypesDeepMax = 16;

/// Reads one application's user types, with the types of their fields.
class UserTypeReader {
 public:
  UserTypeReader(FileBudget& files, Application& application) : files_(files), application_(application) {}

  /// Those that its project lists. What is wrong with a type's own files is told once for all applications:
  /// `told` keeps which were.
  void read(const ProjectFile& project, FileFindings& findings, std::set<std::filesystem::path>& told);
  [[nodiscard]] const TypeWords& words() const { return words_; }
  [[nodiscard]] const std::vector<std::size_t>& elements_of_user() const { return elements_of_user_; }

 private:
  enum class Stand { kListed, kBeingRead, kRead };

  int add(const ProjectFile::Other& listed, const std::filesystem::path& folder, FileFindings& findings,
          bool again);
  void fill(int index, std::set<std::filesystem::path>& told);
  TypeWords words_of(const ProjectFile& project, const std::filesystem::path& file, FileFindings& findings,
                     std::set<std::filesystem::path>& told);
  void fill_fields(int index, const ProjectFile& project, const TypeWords& words, FileFindings& findings);

  FileBudget& files_;
  Application& application_;
  TypeWords words_;
  std::map<std::filesystem::path, int> by_project_;
  std::vector<std::filesystem::path> projects_;
  std::vector<Stand> states_;
  Findings* told_findings_ = nullptr;  // of the application, while read() runs
  int depth_ = 0;
  std::vector<std::size_t> elements_of_user_;
};

/// Reads an application with its libraries.
class ApplicationReader {
 public:
  ApplicationReader(const std::filesystem::path& top, Findings& findings)
      : files_(top), findings_(findings) {}
  /// Null when the project file cannot be read, which is found. `file` is its full path.
  std::shared_ptr<Application> read(const std::filesystem::path& file, int depth);

 private:
  void read_data(Application& application, const ProjectFile& project, const UserTypeReader& types,
                 FileFindings& findings);
  void read_programs(Application& application, const ProjectFile& project, const UserTypeReader& types,
                     FileFindings& findings);
  void read_libraries(Application& application, const ProjectFile& project, FileFindings& findings,
                      int depth);
  static void read_io(Application& application, const std::string& project);
  /// What alias:libLoad("path") of its programs names.
  void read_loadable(Application& application, int depth);
  void add_loadable(Application& application, const Program& program, const Expression& e, int depth);
  /// `missing`: how bad it is when it is not there.
  Loadable read_library(const std::filesystem::path& folder, const ProjectFile::Other& listed,
                        Severity missing, FileFindings& findings, int depth);
  void note_unlisted(const ProjectFile& project, const std::filesystem::path& folder, FileFindings& findings);

  FileBudget files_;
  ElementBudget elements_{kElementsMax};
  Findings& findings_;
  std::map<std::filesystem::path, std::shared_ptr<Application>> read_;
  std::set<std::filesystem::path> being_read_;
  std::set<std::filesystem::path> types_told_;
};

}  // namespace val3
