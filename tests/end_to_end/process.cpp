#include "tests/end_to_end/process.hpp"

#include <fcntl.h>
#include <poll.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <csignal>
#include <fstream>
#include <iterator>
#include <stdexcept>
#include <string_view>
#include <utility>

extern char** environ;

namespace touchcal::testing {
Process::Process(const std::vector<std::string>& arguments, std::filesystem::path error_file,
                 std::chrono::milliseconds patience)
    : error_file_(std::move(error_file)), patience_(patience) {
  const std::string program = std::filesystem::path(TOUCHCAL_PROGRAMS_DIR) / arguments.front();
  std::vector<char*> argv;
  for (const std::string& argument : arguments) argv.push_back(const_cast<char*>(argument.c_str()));
  argv.push_back(nullptr);
  std::array<int, 2> pipe{};
  if (::pipe2(pipe.data(), O_CLOEXEC) != 0) throw std::runtime_error("no pipe");
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_addopen(&actions, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
  posix_spawn_file_actions_adddup2(&actions, pipe[1], STDOUT_FILENO);
  posix_spawn_file_actions_addopen(&actions, STDERR_FILENO, error_file_.c_str(), O_WRONLY | O_CREAT | O_TRUNC,
                                   0600);
  // A socket of this process that lived on in the program would not end for its other side when it is closed
  // here.
  posix_spawn_file_actions_addclosefrom_np(&actions, STDERR_FILENO + 1);
  const int failure = posix_spawn(&pid_, program.c_str(), &actions, nullptr, argv.data(), environ);
  posix_spawn_file_actions_destroy(&actions);
  ::close(pipe[1]);
  output_ = pipe[0];
  if (failure != 0) {
    ::close(output_);
    throw std::runtime_error(program + " cannot be started");
  }
}

Process::~Process() {
  if (output_ >= 0) ::close(output_);
  if (pid_ < 0) return;
  signal(SIGKILL);
  ::waitpid(pid_, nullptr, 0);
}

void Process::signal(int number) const {
  if (pid_ > 0) ::kill(pid_, number);
}

bool Process::is_running() const {
  siginfo_t about{};
  return pid_ > 0 && ::waitid(P_PID, static_cast<id_t>(pid_), &about, WEXITED | WNOHANG | WNOWAIT) == 0 &&
         about.si_pid == 0;
}

/// False when its output has ended.
bool Process::read_more() {
  pollfd readable{output_, POLLIN, 0};
  if (::poll(&readable, 1, static_cast<int>(patience_.count())) <= 0)
    throw std::runtime_error("it says no more after: " + out_);
  std::array<char, 4096> bytes{};
  const ssize_t count = ::read(output_, bytes.data(), bytes.size());
  if (count > 0) out_.append(bytes.data(), static_cast<std::size_t>(count));
  return count > 0;
}

std::string Process::first_line() {
  while (out_.find('\n') == std::string::npos) {
    if (!read_more()) return {};
  }
  return out_.substr(0, out_.find('\n'));
}

std::string Process::wait_for_address() {
  constexpr std::string_view kBefore = "listening on ";
  const std::string line = first_line();
  if (!line.starts_with(kBefore)) throw std::runtime_error("it does not listen: " + out_);
  return line.substr(kBefore.size());
}

std::string Process::wait_for(std::string_view text) {
  for (;;) {
    const std::size_t found = out_.find(text);
    const std::size_t end = found == std::string::npos ? found : out_.find('\n', found);
    if (end != std::string::npos) return out_.substr(found + text.size(), end - found - text.size());
    if (!read_more()) throw std::runtime_error("it ends without '" + std::string(text) + "': " + out_);
  }
}

Finished Process::wait() {
  while (read_more()) {
  }
  int status = 0;
  ::waitpid(std::exchange(pid_, -1), &status, 0);
  std::ifstream error(error_file_, std::ios::binary);
  return {WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status), out_,
          std::string(std::istreambuf_iterator<char>(error), {})};
}

}  // namespace touchcal::testing
