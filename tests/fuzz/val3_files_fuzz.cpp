#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>
#include <string_view>

#include "sim_controller/val3/checks/checks.hpp"
#include "sim_controller/val3/files/read_application.hpp"
#include "sim_controller/val3/language/resolver.hpp"

/// Arbitrary bytes as the files of a small VAL3 project: "=== app/app.pjx" is a line that begins a file.
/// It is read, resolved and checked: nothing crashes or throws, findings have a rule and a file, and the
/// blocks of programs are linked.
namespace {

/// A folder in memory where there is one, and gone with the program.
const std::filesystem::path& apps_folder() {
  static const struct Folder {
    Folder() {
      std::string name =
          std::filesystem::exists("/dev/shm") ? "/dev/shm/val3_fuzz_XXXXXX" : "/tmp/val3_fuzz_XXXXXX";
      if (mkdtemp(name.data()) == nullptr) std::abort();
      path = name;
    }
    ~Folder() { std::filesystem::remove_all(path); }
    Folder(const Folder&) = delete;
    Folder& operator=(const Folder&) = delete;
    std::filesystem::path path;
  } folder;
  return folder.path;
}

/// Names that stay below the folder; the hostile ones are in the files.
bool is_plain(std::string_view name) {
  if (name.empty() || name.size() > 40 || name.find("..") != std::string_view::npos || name[0] == '/')
    return false;
  for (const char c : name)
    if (c <= ' ' || c > '~') return false;
  return true;
}

void write_files(std::string_view input) {
  constexpr std::string_view kMark = "=== ";
  std::error_code error;
  while (!input.empty()) {
    const std::size_t name_end = std::min(input.find('\n'), input.size());
    const std::string_view line = input.substr(0, name_end);
    input.remove_prefix(std::min(name_end + 1, input.size()));
    const std::size_t next = input.starts_with(kMark) ? 0 : input.find("\n=== ");
    const std::string_view bytes = input.substr(0, next == std::string_view::npos ? next
                                                   : next == 0                    ? 0
                                                                                  : next + 1);
    input.remove_prefix(bytes.size());
    if (!line.starts_with(kMark) || !is_plain(line.substr(kMark.size()))) continue;
    const std::filesystem::path path = apps_folder() / line.substr(kMark.size());
    std::filesystem::create_directories(path.parent_path(), error);
    if (!error) std::ofstream(path, std::ios::binary) << bytes;
  }
}

void check_programs(const val3::Application& application) {
  for (const val3::Program& program : application.programs) {
    if (program.lines.empty() || program.lines.back().kind != val3::Line::Kind::kEnd) std::abort();
    for (const val3::Line& line : program.lines)
      if (line.open >= program.lines.size() || line.next >= program.lines.size() ||
          line.close >= program.lines.size() || line.next < line.open || line.close < line.open)
        std::abort();
  }
  for (const val3::Library& library : application.libraries)
    if (library.application) check_programs(*library.application);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  for (const auto& entry : std::filesystem::directory_iterator(apps_folder()))
    std::filesystem::remove_all(entry.path());
  write_files({reinterpret_cast<const char*>(data), size});
  val3::ReadApplication read = val3::read_application(apps_folder() / "app");
  check_programs(read.application);
  val3::resolve(read.application, read.findings);
  val3::check(read.application, {}, read.findings);
  for (const val3::Finding& finding : read.findings)
    if (finding.rule.empty() || finding.at.file.empty() || finding.what.empty()) std::abort();
  return 0;
}
