#include <fcntl.h>
#include <spawn.h>
#include <spdlog/fmt/fmt.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <filesystem>
#include <fstream>
#include <optional>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

#include "service/cli/commands.hpp"
#include "service/cli/daemon_reply.hpp"
#include "service/cli/offline.hpp"

namespace cell {
namespace {

constexpr std::chrono::minutes kDrawingMax{5};  // others may be drawing as well

/// A temporary directory.
class ScratchFolder {
 public:
  ScratchFolder() {
    std::string name = (std::filesystem::temp_directory_path() / "touchcal-report-XXXXXX").string();
    if (!::mkdtemp(name.data())) throw std::runtime_error("no folder can be made in " + name);
    path_ = name;
  }
  ~ScratchFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  ScratchFolder(const ScratchFolder&) = delete;
  ScratchFolder& operator=(const ScratchFolder&) = delete;

  [[nodiscard]] std::filesystem::path file(const char* name) const { return path_ / name; }

 private:
  std::filesystem::path path_;
};

/// Runs a program from PATH without output; returns its exit code, or nothing if there is no such program.
std::optional<int> run_silently(std::vector<std::string> words) {
  posix_spawn_file_actions_t files;
  ::posix_spawn_file_actions_init(&files);
  for (const int descriptor : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO})
    ::posix_spawn_file_actions_addopen(&files, descriptor, "/dev/null", O_RDWR, 0);
  std::vector<char*> argv;
  for (std::string& word : words) argv.push_back(word.data());
  argv.push_back(nullptr);
  pid_t process = 0;
  const int failed = ::posix_spawnp(&process, argv[0], &files, nullptr, argv.data(), environ);
  ::posix_spawn_file_actions_destroy(&files);
  if (failed == ENOENT) return std::nullopt;
  if (failed != 0) return failed;
  int status = 0;
  while (::waitpid(process, &status, 0) == -1 && errno == EINTR) {
  }
  return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

/// A browser prints the page, which has no scripts and no external resources.
std::string pdf_of(const std::string& page) {
  const ScratchFolder folder;
  const std::string from = folder.file("report.html").string(), to = folder.file("report.pdf").string();
  std::ofstream(from, std::ios::binary) << page;
  for (const char* browser : {"chromium", "chromium-browser", "google-chrome"}) {
    std::vector<std::string> words{browser,
                                   "--headless",
                                   "--disable-gpu",
                                   "--user-data-dir=" + folder.file("profile").string(),
                                   "--no-pdf-header-footer",
                                   "--print-to-pdf=" + to,
                                   from};
    if (::geteuid() == 0) words.emplace_back("--no-sandbox");  // chromium has no sandbox for root
    const auto code = run_silently(std::move(words));
    if (!code) continue;
    if (*code != 0 || !std::filesystem::exists(to))
      throw std::runtime_error(fmt::format(
          "{} could not print the report (exit code {}); print the --html report by hand", browser, *code));
    std::ostringstream bytes;
    bytes << std::ifstream(to, std::ios::binary).rdbuf();
    return std::move(bytes).str();
  }
  throw std::runtime_error(
      "the PDF is made by the browser chromium, which is not installed; install it, or print the --html "
      "report "
      "from the browser you have");
}

}  // namespace

ExitCode report_command(const ApiClient& daemon, const ReportArguments& arguments, bool json) {
  demand_run_id(arguments.run_id);
  const bool as_pdf = !json && arguments.format == "pdf";
  if (as_pdf && arguments.file == "-" && ::isatty(STDOUT_FILENO) == 1)
    throw std::invalid_argument("a PDF cannot be shown in a terminal; give --out FILE");
  const std::string format = json ? "json" : as_pdf ? "html" : arguments.format;
  const std::string form = fmt::format("format={}&language={}", format, arguments.language);
  const std::string report = fmt::format("/api/v1/runs/{}/report", arguments.run_id);
  const ApiReply reply =
      arguments.monte_carlo_count
          ? daemon.post(fmt::format("{}/monte-carlo?count={}&{}", report, *arguments.monte_carlo_count, form),
                        "", kDrawingMax)
          : daemon.get(fmt::format("{}?{}", report, form));
  if (reply.status != 200) return print_problem(reply, json);
  write_whole_file(arguments.file, as_pdf ? pdf_of(reply.body) : reply.body, arguments.overwrite);
  if (arguments.file != "-") fmt::print("{}: the report of run {}\n", arguments.file, arguments.run_id);
  return kExitDone;
}

}  // namespace cell
