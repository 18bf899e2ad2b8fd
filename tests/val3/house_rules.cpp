#include "tests/val3/house_rules.hpp"

#include <algorithm>
#include <set>

#include "sim_controller/val3/language/instructions.hpp"

namespace val3 {
namespace {

using Indices = std::set<int>;

bool creates_task(const Line& line) {
  return line.kind == Line::Kind::kTaskCreate || line.kind == Line::Kind::kTaskCreateSync;
}

/// Where the arguments of a call or of a task's program begin.
std::size_t first_argument(const Line& line) {
  if (line.kind == Line::Kind::kTaskCreate) return 2;
  return line.kind == Line::Kind::kTaskCreateSync ? 3 : 0;
}

/// The global that a place belongs to, or -1.
int global_of(const Expression& e) {
  const Expression* base = &e;
  while (base->kind == Expression::Kind::kIndex || base->kind == Expression::Kind::kField)
    base = &base->parts[0];
  const bool is_global = base->reference.to == Reference::To::kGlobal && base->reference.library < 0;
  return is_global ? base->reference.index : -1;
}

template <class Each>
void visit(const Expression& e, const Each& each) {
  each(e);
  for (const Expression& part : e.parts) visit(part, each);
}

class HouseRules {
 public:
  explicit HouseRules(const Application& application) : application_(application) {}

  std::vector<std::string> check() {
    variables();
    tasks();
    return std::move(broken_);
  }

 private:
  void variables() {
    Indices set_by_start;
    for (const int index : reached_from("start")) set_by_start.merge(written_by(program(index)));
    Indices written;
    for (const Program& one : application_.programs) written.merge(written_by(one));
    for (std::size_t i = 0; i < application_.globals.size(); ++i) {
      const Declaration& declared = application_.globals[i].declared;
      const bool is_link = declared.type.kind == Kind::kDio || declared.type.kind == Kind::kSio;
      const bool is_constant = declared.name.starts_with("k");
      const int index = static_cast<int>(i);
      if (!is_link && !is_constant && !set_by_start.contains(index))
        broken(declared.file, declared.line,
               declared.name + " is not set by start: a saved value would live on");
      if (is_constant && written.contains(index))
        broken(declared.file, declared.line, declared.name + " is a constant and is written");
    }
  }

  void tasks() {
    std::set<std::string> killed;
    for (const int index : reached_from("stop"))
      for (const Line& line : program(index).lines)
        for (const Expression& e : line.expressions)
          visit(e, [&](const Expression& call) {
            if (call.kind == Expression::Kind::kCall && call.text == "taskKill")
              killed.insert(call.parts.at(0).text);
          });
    for (const Program& one : application_.programs)
      for (const Line& line : one.lines)
        if (creates_task(line) && !killed.contains(line.expressions[0].text))
          broken(one.file, line.line, "stop does not kill the task " + line.expressions[0].text);
  }

  [[nodiscard]] const Program& program(int index) const {
    return application_.programs[static_cast<std::size_t>(index)];
  }

  /// The program and all that it calls.
  Indices reached_from(std::string_view name) {
    Indices reached;
    reach(application_.program_named(name), reached);
    return reached;
  }
  void reach(int index, Indices& reached) {
    if (index < 0 || !reached.insert(index).second) return;
    for (const Line& line : program(index).lines)
      if (line.kind == Line::Kind::kCall && line.called_library < 0) reach(line.called_program, reached);
  }

  [[nodiscard]] Indices written_by(const Program& one) const {
    Indices written;
    const auto add = [&](const Expression& place) {
      if (const int global = global_of(place); global >= 0) written.insert(global);
    };
    for (const Line& line : one.lines) {
      if (line.kind == Line::Kind::kAssign)
        for (std::size_t i = 0; i + 1 < line.expressions.size(); ++i) add(line.expressions[i]);
      if (line.kind == Line::Kind::kFor) add(line.expressions[0]);
      if (line.kind == Line::Kind::kTaskCreateSync) add(line.expressions[2]);
      if (line.called_program >= 0 && line.called_library < 0) {
        const auto& parameters = program(line.called_program).parameters;
        for (std::size_t i = 0; i < parameters.size(); ++i)
          if (parameters[i].by_reference) add(line.expressions.at(first_argument(line) + i));
      }
      for (const Expression& e : line.expressions)
        visit(e, [&](const Expression& call) { add_written(call, add); });
    }
    return written;
  }

  template <class Add>
  static void add_written(const Expression& call, const Add& add) {
    if (call.kind != Expression::Kind::kCall || call.reference.instruction == nullptr) return;
    const Signature& signature =
        call.reference.instruction->signatures.at(static_cast<std::size_t>(call.reference.index));
    for (std::size_t i = 0; i < std::min(call.parts.size(), signature.parameters.size()); ++i)
      if (signature.parameters[i].by_reference) add(call.parts[i]);
  }

  void broken(const std::string& file, int line, const std::string& what) {
    broken_.push_back(file + ":" + std::to_string(line) + ": " + what);
  }

  const Application& application_;
  std::vector<std::string> broken_;
};

}  // namespace

std::vector<std::string> broken_house_rules(const Application& application) {
  return HouseRules(application).check();
}

}  // namespace val3
