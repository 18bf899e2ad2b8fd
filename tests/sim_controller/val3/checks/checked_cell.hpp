#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "sim_controller/val3/checks/checks.hpp"
#include "sim_controller/val3/language/resolver.hpp"
#include "tests/sim_controller/val3/small_application.hpp"

namespace val3 {

/// What the checks find, without what is never used: a small application has much of that.
inline std::vector<std::string> found_in(SmallApplication small, const CheckOptions& options = {}) {
  Findings findings = std::move(small.findings);
  resolve(small.application, findings);
  check(small.application, options, findings);
  std::erase_if(findings, [](const Finding& one) { return one.rule.starts_with("unused-"); });
  return in_short(findings);
}

inline StoredValue stored(std::string name, std::string value) {
  return {
      .index = {0}, .key = {}, .attributes = {{std::move(name), std::move(value)}}, .fields = {}, .line = 1};
}

/// An application that is as it should be.
inline SmallApplication cell() {
  SmallApplication small;
  for (const auto& [type, name] :
       std::vector<std::pair<std::string_view, std::string_view>>{{"num", "n"},
                                                                  {"num", "nOther"},
                                                                  {"bool", "b"},
                                                                  {"bool", "bLate"},
                                                                  {"string", "s"},
                                                                  {"sio", "si"},
                                                                  {"dio", "d"},
                                                                  {"jointRx", "j"},
                                                                  {"pointRx", "p"},
                                                                  {"tool", "tl"},
                                                                  {"mdesc", "m"}}) {
    small.global(type, name);
    small.application.globals.back().values.push_back(stored("value", "1"));
  }
  small.global("num", "nBytes", {64});
  small.application.globals.back().values.push_back(stored("value", "1"));
  for (Global& one : small.application.globals)
    if (one.declared.name == "si") one.values = {stored("link", "Socket\\host")};
  small.program("stop", "clearBuffer(si)");
  return small;
}

inline std::vector<std::string> found_in_start(std::string_view code) {
  return found_in(cell().program("start", code));
}

}  // namespace val3
