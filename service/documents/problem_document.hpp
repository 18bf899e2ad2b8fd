#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace cell {

/// RFC 9457: what every refusal looks like. The server writes it (http/server/problem.cpp), which knows no
/// documents; a field that says nothing is left out.
struct ProblemDocument {
  struct Unmet {
    std::string code;
    std::string detail;

    template <class Self, class Fields>
    static void visit(Self& self, Fields& fields) {
      fields("code", self.code);
      fields("detail", self.detail);
    }
  };

  std::optional<std::string> type;  // urn:touchcal:problem:KIND
  std::optional<std::string> title;
  std::optional<int> status;
  std::optional<std::string> detail;
  std::optional<std::string> pointer;
  std::optional<std::string> parameter;
  std::optional<std::vector<Unmet>> errors;
  std::optional<std::vector<std::string>> exits;  // commands that the state allows

  template <class Self, class Fields>
  static void visit(Self& self, Fields& fields) {
    fields("type", self.type);
    fields("title", self.title);
    fields("status", self.status);
    fields("detail", self.detail);
    fields("pointer", self.pointer);
    fields("parameter", self.parameter);
    fields("errors", self.errors);
    fields("exits", self.exits);
  }
};

/// DocumentError when the text is no problem.
ProblemDocument read_problem(std::string_view text);

}  // namespace cell
