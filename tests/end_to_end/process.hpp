#pragma once

#include <sys/types.h>

#include <chrono>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace touchcal::testing {

/// What a program that ended has left.
struct Finished {
  int exit_code = -1;  // 128 + signal when a signal ended it
  std::string out;
  std::string err;
};

/// One of the build's programs as a process of its own. Still running when it goes, it is killed.
class Process {
 public:
  /// `arguments` start with the program's name. What it writes to standard error goes to `error_file`.
  /// `patience`: no longer is waited for a word of it, or for its end.
  Process(const std::vector<std::string>& arguments, std::filesystem::path error_file,
          std::chrono::milliseconds patience = std::chrono::minutes(5));
  ~Process();
  Process(const Process&) = delete;
  Process& operator=(const Process&) = delete;

  /// "HOST:PORT" of the line "listening on HOST:PORT"; std::runtime_error when it says something else or
  /// nothing.
  std::string wait_for_address();
  /// Empty where it ends without one; std::runtime_error when it says nothing.
  std::string first_line();
  /// What stands behind `text` in its first line with it; std::runtime_error when there is none.
  std::string wait_for(std::string_view text);
  void signal(int number) const;
  /// False once it has ended, whoever waits for it or not.
  [[nodiscard]] bool is_running() const;
  /// Waits for its end; std::runtime_error when there is none.
  Finished wait();

 private:
  bool read_more();

  std::filesystem::path error_file_;
  std::chrono::milliseconds patience_;
  pid_t pid_ = -1;
  int output_ = -1;  // the reading end of its standard output; -1 once that has ended
  std::string out_;
};

}  // namespace touchcal::testing
