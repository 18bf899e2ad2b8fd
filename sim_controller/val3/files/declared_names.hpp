#pragma once

#include <map>
#include <string>
#include <string_view>

#include "sim_controller/val3/files/file_findings.hpp"
#include "sim_controller/val3/program/application.hpp"

namespace val3 {

/// Names that must differ: of a project's variables, of its programs, of a program's parameters and locals.
class DeclaredNames {
 public:
  explicit DeclaredNames(const Version& language) : language_(language) {}
  /// Tells of a name that is none, is too long for the version, is a keyword, or is there already. False for
  /// the last: the second one is to be left out.
  bool add(std::string_view name, std::string_view what, int line, FileFindings& findings);

 private:
  Version language_;
  std::map<std::string, int, std::less<>> seen_;  // and the line
};

/// s5 and s6 (manual 6, page 20); the tools of s7 write none that are longer.
inline constexpr std::size_t kNameCharactersMax = 15;

}  // namespace val3
