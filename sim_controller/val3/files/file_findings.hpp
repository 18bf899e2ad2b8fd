#pragma once

#include <string>
#include <string_view>
#include <utility>

#include "sim_controller/val3/program/finding.hpp"

namespace val3 {

/// Tells of one file, and of no more than kFindingsPerFileMax things in it; that there are more is told.
class FileFindings {
 public:
  FileFindings(std::string file, Findings& all) : file_(std::move(file)), all_(all) {}

  void error(std::string_view rule, int line, std::string what, std::string remedy = {}) {
    tell(Severity::kError, rule, line, std::move(what), std::move(remedy));
  }
  void warning(std::string_view rule, int line, std::string what, std::string remedy = {}) {
    tell(Severity::kWarning, rule, line, std::move(what), std::move(remedy));
  }
  void note(std::string_view rule, int line, std::string what, std::string remedy = {}) {
    tell(Severity::kNote, rule, line, std::move(what), std::move(remedy));
  }
  void tell(Severity severity, std::string_view rule, int line, std::string what, std::string remedy);

  [[nodiscard]] const std::string& file() const { return file_; }
  [[nodiscard]] Findings& all() { return all_; }

 private:
  std::string file_;
  Findings& all_;
  std::size_t told_ = 0;
};

inline constexpr std::size_t kFindingsPerFileMax = 100;

/// A word of a file as a message shows it: short, and without what a terminal would obey.
std::string shown_word(std::string_view word);

}  // namespace val3
