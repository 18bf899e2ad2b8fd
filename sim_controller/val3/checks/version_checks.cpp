/// What a version of the language has not.
#include <set>

#include "sim_controller/val3/checks/check_rules.hpp"
#include "sim_controller/val3/checks/subject.hpp"
#include "sim_controller/val3/checks/uses.hpp"
#include "sim_controller/val3/language/instructions.hpp"

namespace val3 {
namespace {

constexpr Version kS6{6, 0, 0}, kS64{6, 4, 0}, kS7{7, 0, 0}, kS8{8, 0, 0};
constexpr Version kLastOfManual{6, 4, 99};
constexpr std::size_t kNameMaxUntilS7 = 15;

std::string text_of(const Version& version) {
  return "s" + std::to_string(version.major) + (version.minor > 0 ? "." + std::to_string(version.minor) : "");
}

class VersionChecks {
 public:
  explicit VersionChecks(const CheckSubject& subject) : subject_(subject) {}

  void run() {
    const Application& application = subject_.application;
    for (const Global& global : application.globals) declared(global.declared);
    if (subject_.language < kS7)
      for (const UserType& type : application.user_types)
        if (!type.at.file.empty()) form(type.at.file, type.at.line, 0, "the type " + type.name, kS7);
    for (const Program& program : application.programs) {
      name(program.name, program.file, program.line);
      for (const Parameter& parameter : program.parameters) {
        name(parameter.name, program.file, parameter.line);
        if (parameter.dimensions > 1 && subject_.language < kS7)
          form(program.file, parameter.line, 0, "an array of more than one dimension", kS7);
      }
      for (const Declaration& local : program.locals) declared(local);
      for (const Line& line : program.lines) line_of(program, line);
    }
  }

 private:
  void form(const std::string& file, int line, int column, const std::string& what, const Version& since) {
    subject_.tell(Severity::kError, check_rules::kNewerForm, file, line, column,
                  what + " came with " + text_of(since));
  }

  void name(const std::string& text, const std::string& file, int line) {
    // In the project's own version the reader tells it.
    if (subject_.is_own || subject_.language >= kS8 || text.size() <= kNameMaxUntilS7) return;
    subject_.tell(Severity::kError, check_rules::kNewerName, file, line, 0,
                  text + " has " + std::to_string(text.size()) + " characters, and until s7 a name has 15");
  }

  void declared(const Declaration& one) {
    name(one.name, one.file, one.line);
    if (subject_.language >= kS7) return;
    if (one.is_collection()) form(one.file, one.line, 0, "a collection", kS7);
    if (one.sizes.size() > 1) form(one.file, one.line, 0, "an array of more than one dimension", kS7);
    if (one.type.kind == Kind::kScreen) form(one.file, one.line, 0, "a screen", kS7);
  }

  void line_of(const Program& program, const Line& line) {
    if (line.is_shorthand) shorthand(program, line);
    if (subject_.language < kS64) {
      if (line.kind == Line::Kind::kElseIf) form(program.file, line.line, line.column, "elseIf", kS64);
      if (line.kind == Line::Kind::kCase && line.expressions.size() > 1)
        form(program.file, line.line, line.column, "a case of several values", kS64);
      if (line.kind == Line::Kind::kSwitch && !line.expressions.empty() && !line.expressions[0].is_unknown &&
          line.expressions[0].type.kind != Kind::kNum)
        form(program.file, line.line, line.column, "a switch over what is no num", kS64);
    }
    visit_expressions(line, [&](const Expression& e) {
      if (e.kind == Expression::Kind::kCall && e.reference.instruction != nullptr)
        instruction(program, line, e);
    });
  }

  /// The manuals to s7 do not have it, and a public application of s7.2 uses it.
  void shorthand(const Program& program, const Line& line) {
    constexpr const char* kWhat = "? to print a value";
    if (subject_.language < kS7) {
      form(program.file, line.line, line.column, kWhat, kS7);
    } else if (subject_.language < kS8) {
      subject_.tell(Severity::kNote, check_rules::kNewerForm, program.file, line.line, line.column,
                    std::string(kWhat) + " is in no manual of s7, where programs use it all the same");
    }
  }

  void instruction(const Program& program, const Line& line, const Expression& e) {
    const Instruction& known = *e.reference.instruction;
    const auto signature = static_cast<std::size_t>(e.reference.index);
    Version since = known.since;
    if (e.reference.index >= 0 && signature < known.signatures.size())
      since = std::max(since, known.signatures[signature].since);
    if (subject_.language < since && known.addon.empty()) {
      const bool is_form = since != known.since;
      const std::string what = e.text + "()" + (is_form ? " with these arguments" : "");
      // The manual of s6.4 lists all that there was until then. Between it and s7 nobody has said.
      if (since <= kLastOfManual || subject_.language <= kLastOfManual)
        subject_.tell(Severity::kError, check_rules::kNewerInstruction, program, e,
                      what + " came with " + text_of(since));
      else
        subject_.tell(Severity::kWarning, check_rules::kNewerInstruction, program, e,
                      what + " came with " + text_of(since) + ", or after s6.4: no manual to s6.4 has it",
                      "see whether the controller has it, or write what s6.4 has");
    }
    if (e.text == "sioCtrl" && subject_.language < kS7) channel_option(program, e);
    if (known.page6 == 0 && known.page5 != 0 && subject_.language >= kS6 && older_.insert(&known).second)
      subject_.tell(Severity::kNote, check_rules::kOlderInstruction, program, e,
                    e.text + "() is of s5, and the manual of s6 has it no more");
    const bool is_move = e.text == "movej" || e.text == "movel" || e.text == "movec";
    if (is_move && subject_.language < kS7 && line.kind != Line::Kind::kInstruction)
      form(program.file, e.line, e.column, "a move's result", kS7);
  }

  /// What sioCtrl of s7 takes and the manual of s6 (page 64) has not.
  void channel_option(const Program& program, const Expression& e) {
    if (e.parts.size() != 3 || e.parts[1].kind != Expression::Kind::kText) return;
    const bool is_quiet = e.parts[1].text == "timeout" && constant_of(e.parts[2]).value_or(0.0) < 0.0;
    if (is_quiet || e.parts[1].text == "nagle")
      subject_.tell(Severity::kWarning, check_rules::kNewerForm, program, e,
                    (is_quiet ? std::string("a time-out of -1") : std::string("\"nagle\"")) +
                        " of sioCtrl() came with s7",
                    is_quiet ? "give it a short time" : "");
  }

  const CheckSubject& subject_;
  std::set<const Instruction*> older_;
};

}  // namespace

void check_versions(const CheckSubject& subject) { VersionChecks(subject).run(); }

}  // namespace val3
