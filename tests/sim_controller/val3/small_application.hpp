#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "sim_controller/val3/language/parser.hpp"
#include "sim_controller/val3/program/application.hpp"

namespace val3 {

/// An application put together in a test. Its program `start` is in start.pgx, its code from line 1 on: the
/// first line behind `begin` is line 2.
class SmallApplication {
 public:
  Application application;
  Findings findings;  // of the parser

  SmallApplication& global(std::string_view type, std::string_view name, std::vector<std::size_t> sizes = {1},
                           bool is_public = false) {
    application.globals.push_back({declared(type, name, std::move(sizes)), is_public, {}});
    return *this;
  }
  /// `locals` are "num l_n", "string l_s".
  SmallApplication& program(const std::string& name, std::string_view code,
                            std::vector<Parameter> parameters = {},
                            const std::vector<std::pair<std::string_view, std::string_view>>& locals = {}) {
    Program program{.name = name,
                    .file = name + ".pgx",
                    .is_public = true,
                    .line = 1,
                    .parameters = std::move(parameters),
                    .locals = {},
                    .lines = {}};
    for (const auto& [type, local] : locals) program.locals.push_back(declared(type, local, {1}));
    program.lines = parse("begin\n" + std::string(code) + "\nend", program.file, 1, findings);
    application.programs.push_back(std::move(program));
    return *this;
  }
  SmallApplication& library(std::string_view alias, std::shared_ptr<Application> there) {
    application.libraries.push_back({std::string(alias), std::string(alias), true, {}, std::move(there)});
    return *this;
  }
  [[nodiscard]] Type type(std::string_view word) const {
    const int user = application.user_type_named(word);
    return user >= 0 ? Type{Kind::kUser, user} : Type{kind_named(word), -1};
  }
  [[nodiscard]] Parameter value(std::string_view word, std::string_view name) const {
    return {std::string(name), type(word), false, 0, 1};
  }
  /// One element where `dimensions` is 0, else an array.
  [[nodiscard]] Parameter reference(std::string_view word, std::string_view name, int dimensions = 0) const {
    return {std::string(name), type(word), true, dimensions, 1};
  }
  [[nodiscard]] Declaration declared(std::string_view word, std::string_view name,
                                     std::vector<std::size_t> sizes) const {
    return {std::string(name), type(word), std::move(sizes), "small.dtx", 1};
  }
};

/// A finding as the tests compare it: "start.pgx:2 wrong-type".
inline std::string in_short(const Finding& finding) {
  return finding.at.file + ":" + std::to_string(finding.at.line) + " " + finding.rule;
}
inline std::vector<std::string> in_short(const Findings& findings) {
  std::vector<std::string> all;
  for (const Finding& finding : findings) all.push_back(in_short(finding));
  return all;
}

}  // namespace val3
