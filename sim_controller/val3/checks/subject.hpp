#pragma once

#include <string>
#include <string_view>
#include <utility>

#include "sim_controller/val3/checks/program_graph.hpp"
#include "sim_controller/val3/program/application.hpp"

namespace val3 {

/// What the checks look at, and where they tell. Each of them is a function of its own file.
struct CheckSubject {
  const Application& application;
  const ProgramGraph& graph;
  Version language;    // deviations from it are told
  bool is_own = true;  // it is the version of the project itself
  Findings& findings;

  void tell(Severity severity, std::string_view rule, const std::string& file, int line, int column,
            std::string what, std::string remedy = {}) const {
    findings.push_back(
        {severity, std::string(rule), {file, line, column}, std::move(what), std::move(remedy)});
  }
  void tell(Severity severity, std::string_view rule, const Program& program, const Line& line,
            std::string what, std::string remedy = {}) const {
    tell(severity, rule, program.file, line.line, line.column, std::move(what), std::move(remedy));
  }
  void tell(Severity severity, std::string_view rule, const Program& program, const Expression& e,
            std::string what, std::string remedy = {}) const {
    tell(severity, rule, program.file, e.line, e.column, std::move(what), std::move(remedy));
  }
};

void check_tasks(const CheckSubject& subject);      // synchronous tasks: what waits, their periods
void check_loops(const CheckSubject& subject);      // loops in which nothing waits
void check_flow(const CheckSubject& subject);       // lines that are never reached
void check_locals(const CheckSubject& subject);     // read before they are set, never used
void check_globals(const CheckSubject& subject);    // never set, never used; programs never called
void check_channels(const CheckSubject& subject);   // sockets never closed
void check_constants(const CheckSubject& subject);  // mistakes that are written out, run memory
void check_traps(const CheckSubject& subject);      // what a manual warns of
void check_versions(const CheckSubject& subject);   // what another version has not

}  // namespace val3
