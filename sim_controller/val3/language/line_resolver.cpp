#include "sim_controller/val3/language/line_resolver.hpp"

#include <algorithm>
#include <cctype>

#include "sim_controller/val3/language/resolver_rules.hpp"

namespace val3 {
namespace {

constexpr Type kNumber{Kind::kNum, -1};
constexpr Type kTruth{Kind::kBool, -1};
constexpr Type kText{Kind::kString, -1};
constexpr std::size_t kTaskNameCharactersMax = 15;
constexpr std::size_t kTaskNameCharactersMaxS8 = 36;  // as other names
constexpr double kTaskPriorityMax = 100.0;

std::string called_name(const Line& line) {
  return line.alias.empty() ? line.program : line.alias + ":" + line.program;
}

}  // namespace

void LineResolver::tell(const Line& line, std::string_view rule, std::string what, std::string remedy) {
  findings_.push_back({Severity::kError,
                       std::string(rule),
                       {program_.file, line.line, line.column},
                       std::move(what),
                       std::move(remedy)});
}

void LineResolver::resolve(std::vector<Line>& lines, Line& line) {
  auto& e = line.expressions;
  switch (line.kind) {
    case Line::Kind::kAssign:
      return resolve_assignment(line);
    case Line::Kind::kInstruction:
      for (Expression& one : e) expressions_.resolve(one);
      return;
    case Line::Kind::kCall:
      return resolve_call(line, 0);
    case Line::Kind::kTaskCreate:
    case Line::Kind::kTaskCreateSync:
      return resolve_task(line);
    case Line::Kind::kIf:
    case Line::Kind::kElseIf:
    case Line::Kind::kWhile:
    case Line::Kind::kUntil:
      for (Expression& one : e) expressions_.resolve_condition(one);
      return;
    case Line::Kind::kFor:
      return resolve_for(line);
    case Line::Kind::kSwitch:
      for (Expression& one : e) expressions_.resolve(one);
      return;
    case Line::Kind::kCase:
      return resolve_case(lines[std::min(line.open, lines.size() - 1)], line);
    default:
      return;
  }
}

void LineResolver::resolve_assignment(Line& line) {
  if (line.expressions.size() < 2) return;
  Expression& value = line.expressions.back();
  expressions_.resolve(value);
  for (std::size_t i = line.expressions.size() - 1; i-- > 0;) {
    Expression& place = line.expressions[i];
    if (!expressions_.resolve_place(place) || place.is_unknown) continue;
    expressions_.expect(value, place.type, "what it is assigned to");
  }
}

void LineResolver::resolve_for(Line& line) {
  if (line.expressions.empty()) return;
  Expression& counter = line.expressions[0];
  if (expressions_.resolve_place(counter)) expressions_.expect(counter, kNumber, "the counter of 'for'");
  for (std::size_t i = 1; i < line.expressions.size(); ++i)
    expressions_.resolve_as(line.expressions[i], kNumber, i == 3 ? "a step" : "a limit of 'for'");
}

void LineResolver::resolve_case(const Line& opening, Line& line) {
  for (Expression& value : line.expressions) {
    expressions_.resolve(value);
    if (opening.kind != Line::Kind::kSwitch || opening.expressions.empty()) continue;
    Expression selector = opening.expressions[0];
    if (!expressions_.comparable(selector, value))
      expressions_.fail(resolver_rules::kCaseType, value,
                        "'switch' asks for a " + expressions_.type_name(selector) + ", and this is a " +
                            expressions_.type_name(value));
  }
}

const Program* LineResolver::called_program(Line& line) {
  const Scope* owner = &scope_;
  if (!line.alias.empty()) {
    line.called_library = scope_.library(line.alias);
    if (line.called_library < 0) {
      if (line.alias != "io" || scope_.application().form != 5)
        tell(line, resolver_rules::kUndefinedLibrary, "no library has the alias " + line.alias,
             "declare it in the project");
      return nullptr;
    }
    owner = scope_.of_library(line.called_library);
    if (owner == nullptr) return nullptr;
  }
  line.called_program = owner->program(line.program);
  if (line.called_program < 0) {
    if (owner->application().is_unread(line.program)) return nullptr;
    tell(line, resolver_rules::kUndefinedProgram, "no program is called " + called_name(line));
    return nullptr;
  }
  const Program& called = owner->application().programs[static_cast<std::size_t>(line.called_program)];
  if (owner != &scope_ && !called.is_public)
    tell(line, resolver_rules::kNotPublic, called_name(line) + " is not public in that library",
         "make it public there");
  return &called;
}

void LineResolver::resolve_call(Line& line, std::size_t first_argument) {
  for (std::size_t i = first_argument; i < line.expressions.size(); ++i)
    expressions_.resolve(line.expressions[i]);
  const Program* const called = called_program(line);
  if (called == nullptr) return;
  const std::size_t given = line.expressions.size() - first_argument;
  const std::size_t wanted = called->parameters.size();
  if (given != wanted)
    tell(line, given < wanted ? resolver_rules::kMissingArgument : resolver_rules::kExtraArgument,
         called_name(line) + " takes " + std::to_string(wanted) + " arguments, and " + std::to_string(given) +
             " are given");
  for (std::size_t i = 0; i < std::min(given, wanted); ++i)
    check_argument(line, *called, called->parameters[i], line.expressions[first_argument + i]);
}

void LineResolver::check_argument(Line& line, const Program& called, const Parameter& parameter,
                                  Expression& argument) {
  const Application& owner =
      line.called_library < 0 ? scope_.application() : scope_.of_library(line.called_library)->application();
  const Type wanted = scope_.imported(owner, parameter.type);
  const bool is_scara = wanted.kind == Kind::kJointRs || wanted.kind == Kind::kPointRs;
  if (is_scara || !is_known(scope_.application(), wanted)) return;
  const std::string where = "parameter " + parameter.name + " of " + called.name;
  if (parameter.by_reference) return check_reference(line, parameter, wanted, argument, where);
  expressions_.demand_no_signal(argument, wanted.kind, where);
  expressions_.expect(argument, wanted, where);
}

void LineResolver::check_reference(Line& line, const Parameter& parameter, const Type& wanted,
                                   Expression& argument, const std::string& where) {
  if (argument.is_unknown) return;
  if (!argument.is_place) {
    expressions_.expect(argument, wanted, where);
    if (!argument.is_unknown)
      expressions_.tell(Severity::kNote, resolver_rules::kConstantByReference, argument,
                        where + " is a reference, and gets a value: what is written to it is lost");
    return;
  }
  if (argument.type != wanted)
    return expressions_.fail(resolver_rules::kWrongType, argument,
                             where + " is a reference to a " + expressions_.type_name(wanted) +
                                 ", and this is a " + expressions_.type_name(argument));
  const bool is_indexed = argument.kind == Expression::Kind::kIndex;
  const Shape shape = expressions_.shape(is_indexed ? argument.parts[0] : argument);
  const bool is_counted = parameter.dimensions > 0 && shape.has_elements() && !shape.is_collection;
  if (is_counted && shape.dimensions != parameter.dimensions)
    expressions_.fail(resolver_rules::kArrayDimensions, argument,
                      where + " is an array of " + std::to_string(parameter.dimensions) +
                          " dimensions, and this has " + std::to_string(shape.dimensions));
  if (line.kind != Line::Kind::kCall) demand_global(argument, where);
}

void LineResolver::demand_global(Expression& e, const std::string& what) {
  const Reference::To to = root_of(e).reference.to;
  if (to != Reference::To::kLocal && to != Reference::To::kParameter) return;
  expressions_.fail(resolver_rules::kLocalToTask, e,
                    what + " refers to a " + (to == Reference::To::kLocal ? "local" : "parameter") +
                        ", which is gone while the task lives",
                    "give it a global");
}

void LineResolver::resolve_task(Line& line) {
  const std::size_t leading = line.kind == Line::Kind::kTaskCreate ? 2 : 3;
  auto& e = line.expressions;
  if (e.size() < leading) return;
  expressions_.resolve_as(e[0], kText, "a task's name");
  check_task_name(e[0]);
  expressions_.resolve_as(e[1], kNumber, leading == 2 ? "a task's priority" : "a task's period");
  if (leading == 2 && e[1].kind == Expression::Kind::kNumber &&
      (e[1].number < 1.0 || e[1].number > kTaskPriorityMax))
    expressions_.tell(Severity::kWarning, resolver_rules::kTaskPriority, e[1],
                      "a task's priority is from 1 to 100: the line fails when it runs");
  if (leading == 3 && expressions_.resolve_place(e[2]) && !e[2].is_unknown) {
    if (e[2].type == kTruth)
      demand_global(e[2], "the overrun flag");
    else
      expressions_.fail(resolver_rules::kWrongType, e[2],
                        "the overrun flag is a bool, and this is a " + expressions_.type_name(e[2]));
  }
  resolve_call(line, leading);
}

void LineResolver::check_task_name(Expression& name) {
  if (name.kind != Expression::Kind::kText || name.is_unknown) return;
  const std::size_t longest =
      scope_.application().language >= Version{8, 0, 0} ? kTaskNameCharactersMaxS8 : kTaskNameCharactersMax;
  const bool is_valid = !name.text.empty() && name.text.size() <= longest &&
                        std::ranges::all_of(name.text, [](unsigned char c) {
                          return c < 0x80 && (std::isalnum(c) != 0 || c == '_');
                        });
  if (!is_valid)
    expressions_.tell(Severity::kWarning, resolver_rules::kTaskName, name,
                      "a task's name has 1 to " + std::to_string(longest) +
                          " letters, digits and _: error 29 when it runs");
}

}  // namespace val3
