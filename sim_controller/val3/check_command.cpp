#include "sim_controller/val3/check_command.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <ostream>
#include <set>
#include <vector>

#include "sim_controller/val3/checks/checks.hpp"
#include "sim_controller/val3/checks/report.hpp"
#include "sim_controller/val3/checks/sarif.hpp"
#include "sim_controller/val3/files/file_rules.hpp"
#include "sim_controller/val3/files/read_application.hpp"
#include "sim_controller/val3/language/resolver.hpp"

namespace val3 {
namespace {

namespace fs = std::filesystem;

constexpr int kLastMinor = 99;  // of a version that is named by its first number only

bool is_project(const fs::path& file) {
  std::string extension = file.extension().string();
  std::ranges::transform(extension, extension.begin(), [](unsigned char c) { return std::tolower(c); });
  return extension == ".pjx";
}

struct Projects {
  std::vector<fs::path> files;
  std::string problem;  // why they could not all be looked for
};

Projects find_projects(const fs::path& folder) {
  std::error_code error;
  if (fs::is_regular_file(folder, error)) {
    if (is_project(folder)) return {{folder}, {}};
    return {{}, folder.string() + " is no project: name a folder or a .pjx file"};
  }
  if (!fs::is_directory(folder, error))
    return {{}, folder.string() + " is not there: name a folder with a VAL3 project"};
  Projects found;
  std::size_t seen = 0;
  fs::recursive_directory_iterator at(folder, fs::directory_options::skip_permission_denied, error);
  for (; !error && at != fs::recursive_directory_iterator(); at.increment(error)) {
    if (++seen > kEntriesMax || found.files.size() >= kProjectsMax) {
      found.problem = folder.string() + " holds too many files or projects: check its folders one by one";
      break;
    }
    std::error_code of_entry;
    if (at->is_regular_file(of_entry) && is_project(at->path())) found.files.push_back(at->path());
  }
  if (error)
    found.problem = folder.string() + " cannot be read: " + error.message() + "; give the right to read it";
  if (found.files.empty() && found.problem.empty())
    found.problem = folder.string() + " holds no VAL3 project: name the folder of a .pjx file";
  std::ranges::sort(found.files);
  return found;
}

fs::path normal(const fs::path& path) {
  std::error_code error;
  fs::path result = fs::weakly_canonical(path, error);
  return error ? path.lexically_normal() : result;
}

/// Projects that are the library or the type of another: they need no start and no stop.
void add_used(const Application& application, std::set<fs::path>& used) {
  const fs::path folder = application.folder;
  for (const UserType& type : application.user_types)
    if (!type.project.empty()) used.insert(normal(folder / type.project));
  const auto add = [&used](const std::shared_ptr<Application>& library) {
    if (library && used.insert(normal(fs::path(library->folder) / library->project)).second)
      add_used(*library, used);
  };
  for (const Library& library : application.libraries) {
    add(library.application);
    for (const Loadable& loadable : library.loadable) add(loadable.application);
  }
}

bool is_unreadable(const Finding& finding, const fs::path& project) {
  const std::array rules{file_rules::kNoProject, file_rules::kFileUnreadable, file_rules::kFileTooLarge,
                         file_rules::kBrokenXml, file_rules::kUnknownForm};
  return std::ranges::find(rules, finding.rule) != rules.end() &&
         fs::path(finding.at.file).filename() == project.filename();
}

class Checking {
 public:
  explicit Checking(const CheckCommand& command) : command_(command) {}

  void project(const fs::path& file) {
    ReadApplication read = read_application(file);
    bool is_read = true;
    for (const Finding& finding : read.findings) is_read = is_read && !is_unreadable(finding, file);
    if (is_read) {
      resolve(read.application, read.findings);
      check(read.application, {command_.language}, read.findings);
      add_used(read.application, used_);
    } else {
      unreadable_.push_back(file);
    }
    const bool is_library =
        read.application.program_named("start") < 0 && read.application.program_named("stop") < 0;
    for (Finding& finding : read.findings) {
      if (finding.rule == file_rules::kNoStart && is_library) {
        finding.severity = Severity::kNote;
        libraries_.push_back(std::move(finding));
        libraries_.back().at.file = shown(file, libraries_.back().at.file);
        library_files_.push_back(normal(file));
        continue;
      }
      finding.at.file = shown(file, finding.at.file);
      findings_.push_back(std::move(finding));
    }
  }

  Findings take_findings() {
    for (std::size_t i = 0; i < libraries_.size(); ++i)
      if (!used_.contains(library_files_[i])) findings_.push_back(std::move(libraries_[i]));
    sort_findings(findings_);
    return std::move(findings_);
  }
  [[nodiscard]] const std::vector<fs::path>& unreadable() const { return unreadable_; }

 private:
  /// As the folder was named, so that a terminal or an editor finds it.
  static std::string shown(const fs::path& project, const std::string& file) {
    return (project.parent_path() / file).lexically_normal().string();
  }

  const CheckCommand& command_;
  Findings findings_;
  Findings libraries_;  // that a project is no application
  std::vector<fs::path> library_files_;
  std::set<fs::path> used_;
  std::vector<fs::path> unreadable_;
};

}  // namespace

std::optional<Version> language_named(std::string_view text) {
  if (!text.starts_with('s') && !text.starts_with('S')) return std::nullopt;
  text.remove_prefix(1);
  std::array<int, 3> numbers{0, kLastMinor, kLastMinor};
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    const auto [rest, error] = std::from_chars(text.data(), text.data() + text.size(), numbers[i]);
    if (error != std::errc{} || numbers[i] < 0) return std::nullopt;
    text.remove_prefix(static_cast<std::size_t>(rest - text.data()));
    if (text.empty()) break;
    if (!text.starts_with('.')) return std::nullopt;
    text.remove_prefix(1);
    if (i + 1 == numbers.size()) return std::nullopt;
  }
  const bool is_known = numbers[0] >= 5 && numbers[0] <= 8;
  return is_known ? std::optional(Version{numbers[0], numbers[1], numbers[2]}) : std::nullopt;
}

CheckExit run_check(const CheckCommand& command, std::ostream& out, std::ostream& errors) {
  const Projects projects = find_projects(command.folder);
  if (!projects.problem.empty()) errors << "cs8sim: " << projects.problem << '\n';
  if (projects.files.empty()) return kCheckUnreadable;
  Checking checking(command);
  for (const fs::path& file : projects.files) checking.project(file);
  const Findings findings = checking.take_findings();
  if (command.json)
    write_sarif(findings, command.tool_version, out);
  else
    write_text(findings, projects.files.size(), out);
  for (const fs::path& file : checking.unreadable())
    errors << "cs8sim: " << file.string() << " cannot be read: mend what is found in it, and check again\n";
  if (!projects.problem.empty() || !checking.unreadable().empty()) return kCheckUnreadable;
  const FindingCounts counts = count_findings(findings);
  return counts.errors + counts.warnings > 0 ? kCheckFindings : kCheckClean;
}

}  // namespace val3
