#include "tests/val3/checks.hpp"

#include <algorithm>
#include <cctype>
#include <functional>
#include <set>

#include "tests/val3/instructions.hpp"

namespace val3 {
namespace {

using Names = std::set<std::string, std::less<>>;

void visit(const Expression& e, const std::function<void(const Expression&)>& each) {
  each(e);
  for (const Expression& part : e.parts) visit(part, each);
}
void visit(const Program& program, const std::function<void(const Expression&)>& each) {
  for (const Statement& s : program.statements)
    for (const Expression& e : s.expressions) visit(e, each);
}

bool creates_task(const Statement& s) {
  return s.kind == StatementKind::kTaskCreate || s.kind == StatementKind::kTaskCreateSync;
}

/// Programs that `from` calls, directly or not, and itself; with `tasks` also those it creates tasks of.
void reach(const Application& application, const std::string& from, bool tasks, Names& reached) {
  const auto found = application.programs.find(from);
  if (found == application.programs.end() || !reached.insert(from).second) return;
  for (const Statement& s : found->second.statements)
    if (s.kind == StatementKind::kCall || (tasks && creates_task(s)))
      reach(application, s.program, tasks, reached);
}

/// Names of the arguments that a program takes by reference.
void add_references(const Application& application, const Statement& s, std::size_t first,
                    std::vector<std::string>& names) {
  const auto found = application.programs.find(s.program);
  if (found == application.programs.end()) return;
  const auto& parameters = found->second.parameters;
  for (std::size_t i = 0; i < parameters.size() && first + i < s.expressions.size(); ++i)
    if (parameters[i].by_reference) names.push_back(s.expressions[first + i].text);
}

class Checker {
 public:
  Checker(const Application& application, const CheckOptions& options, std::vector<Problem>& problems)
      : application_(application), options_(options), problems_(problems) {}

  void names() {
    one_name(application_.name, application_.name + ".pjx", 0);
    for (const auto& [name, global] : application_.globals)
      if (global.line != 0) free_name(name, data_file(), global.line);
    for (const auto& [name, program] : application_.programs) {
      free_name(name, program.file, 0);
      if (application_.globals.contains(name)) complain(program.file, 0, name + " is also a variable");
      Names own;
      const auto own_name = [&](const std::string& variable) {
        free_name(variable, program.file, 0);
        if (!own.insert(variable).second) complain(program.file, 0, variable + " is declared twice");
        if (application_.globals.contains(variable)) complain(program.file, 0, variable + " hides a global");
      };
      for (const Parameter& p : program.parameters) own_name(p.name);
      for (const Local& l : program.locals) own_name(l.name);
    }
  }

  void assigned_in_start() {
    Names set;
    Names reached;
    reach(application_, "start", false, reached);
    for (const std::string& name : reached)
      for (const std::string& written : written_names(application_, application_.programs.at(name)))
        set.insert(written);
    for (const auto& [name, global] : application_.globals) {
      if (global.line == 0 || global.type == Type::kDio || global.type == Type::kSio) continue;
      if (!name.starts_with(options_.constant_prefix) && !set.contains(name))
        complain(data_file(), global.line, name + " is not set by start: a saved value would live on");
    }
    for (const auto& [name, program] : application_.programs)
      for (const std::string& written : written_names(application_, program))
        if (written.starts_with(options_.constant_prefix) && application_.globals.contains(written))
          complain(program.file, 0, written + " is a constant and is written");
  }

  void tasks_are_killed() {
    Names killed;
    Names in_stop;
    reach(application_, "stop", false, in_stop);
    for (const std::string& name : in_stop)
      visit(application_.programs.at(name), [&](const Expression& e) {
        if (e.kind == ExpressionKind::kInstruction && e.text == "taskKill" && e.parts.size() == 1)
          killed.insert(key(e.parts[0]));
      });
    for (const auto& [name, program] : application_.programs)
      for (const Statement& s : program.statements) {
        if (!creates_task(s)) continue;
        const Expression& task = s.expressions[0];
        if (!killed.contains(key(task)))
          complain(program.file, s.line, "stop does not kill the task " + task.text);
        if (task.kind == ExpressionKind::kText) one_name(task.text, program.file, s.line);
      }
  }

  void synchronous_tasks_do_not_wait() {
    Names reached;
    for (const auto& [name, program] : application_.programs)
      for (const Statement& s : program.statements)
        if (s.kind == StatementKind::kTaskCreateSync) reach(application_, s.program, false, reached);
    for (const std::string& name : reached) {
      const Program& program = application_.programs.at(name);
      visit(program, [&](const Expression& e) {
        if (e.kind != ExpressionKind::kInstruction) return;
        const Instruction* instruction = find_instruction(e.text);
        if (instruction != nullptr && instruction->blocks)
          complain(program.file, e.line, e.text + " in a synchronous task");
      });
    }
  }

  void nothing_is_idle() {
    Names used;
    Names reached;
    reach(application_, "start", true, reached);
    reach(application_, "stop", true, reached);
    for (const auto& [name, program] : application_.programs) {
      if (!reached.contains(name)) complain(program.file, 0, "nobody calls " + name);
      Names here;
      visit(program, [&](const Expression& e) {
        if (e.kind == ExpressionKind::kName) here.insert(e.text);
      });
      for (const Local& l : program.locals)
        if (!here.contains(l.name)) complain(program.file, 0, "nobody uses " + l.name);
      for (const Parameter& p : program.parameters)
        if (!here.contains(p.name)) complain(program.file, 0, "nobody uses " + p.name);
      used.merge(here);
    }
    for (const auto& [name, global] : application_.globals)
      if (global.line != 0 && !used.contains(name)) complain(data_file(), global.line, "nobody uses " + name);
  }

 private:
  void complain(const std::string& file, int line, const std::string& text) {
    problems_.push_back({file, line, text});
  }
  [[nodiscard]] std::string data_file() const { return application_.name + ".dtx"; }

  static std::string key(const Expression& e) {
    return (e.kind == ExpressionKind::kText ? "text " : "name ") + e.text +
           (e.parts.empty() ? "" : "[" + std::to_string(e.parts[0].number) + "]");
  }

  void one_name(const std::string& name, const std::string& file, int line) {
    constexpr std::size_t kLongest = 15;
    const bool letters =
        !name.empty() && std::isalpha(static_cast<unsigned char>(name[0])) != 0 &&
        std::ranges::all_of(name, [](unsigned char c) { return std::isalnum(c) != 0 || c == '_'; });
    if (!letters) complain(file, line, "'" + name + "' is no name");
    if (name.size() > kLongest) complain(file, line, name + " has more than 15 characters");
  }
  void free_name(const std::string& name, const std::string& file, int line) {
    one_name(name, file, line);
    static const Names words{"if",        "then",       "else",
                             "elseIf",    "endIf",      "while",
                             "endWhile",  "for",        "to",
                             "step",      "endFor",     "do",
                             "until",     "switch",     "case",
                             "break",     "default",    "endSwitch",
                             "call",      "return",     "begin",
                             "end",       "and",        "or",
                             "xor",       "not",        "true",
                             "false",     "off",        "joint",
                             "Cartesian", "taskCreate", "taskCreateSync",
                             "num",       "bool",       "string"};
    if (words.contains(name) || find_instruction(name) != nullptr)
      complain(file, line, name + " is a word of the language");
  }

  const Application& application_;
  const CheckOptions& options_;
  std::vector<Problem>& problems_;
};

}  // namespace

std::vector<std::string> written_names(const Application& application, const Program& program) {
  std::vector<std::string> names;
  for (const Statement& s : program.statements) {
    if (s.kind == StatementKind::kAssign) names.push_back(s.expressions[0].text);
    if (s.kind == StatementKind::kCall) add_references(application, s, 0, names);
    if (s.kind == StatementKind::kTaskCreate) add_references(application, s, 2, names);
    if (s.kind == StatementKind::kTaskCreateSync) {
      names.push_back(s.expressions[2].text);
      add_references(application, s, 3, names);
    }
  }
  visit(program, [&](const Expression& e) {
    if (e.kind != ExpressionKind::kInstruction) return;
    const Instruction* known = find_instruction(e.text);
    for (std::size_t i = 0; known != nullptr && i < std::min(e.parts.size(), known->parameters.size()); ++i)
      if (known->parameters[i].writes) names.push_back(e.parts[i].text);
  });
  return names;
}

std::vector<Problem> check(const Application& application, const CheckOptions& options) {
  std::vector<Problem> problems;
  check_types(application, problems);
  Checker checker(application, options, problems);
  checker.names();
  checker.assigned_in_start();
  checker.tasks_are_killed();
  checker.synchronous_tasks_do_not_wait();
  checker.nothing_is_idle();
  return problems;
}

}  // namespace val3
