#include "sim_controller/val3/files/built_in_io.hpp"

#include <algorithm>
#include <array>
#include <set>
#include <string>
#include <string_view>

#include "sim_controller/val3/language/instructions.hpp"

namespace val3 {
namespace {

struct NumberedSignals {
  std::string_view word;
  int first = 0;
  int count = 0;
};
constexpr std::array kNumbered{NumberedSignals{"bIn", 0, 16},  NumberedSignals{"bOut", 0, 16},
                               NumberedSignals{"fIn", 0, 2},   NumberedSignals{"fOut", 0, 1},
                               NumberedSignals{"usrIn", 0, 2}, NumberedSignals{"valve", 1, 2}};
/// Boards of the cell have more of them: so far they are counted where a program names them.
constexpr std::array<std::string_view, 2> kOfBoards{"bIn", "bOut"};
constexpr std::size_t kBoardDigitsMax = 3;
constexpr std::array<std::string_view, 2> kTemperatures{"CBT_TEMP", "CPU_TEMP"};
constexpr std::array<std::string_view, 5> kChannelInstructions{"sioLink", "sioGet", "sioSet", "sioCtrl",
                                                               "clearBuffer"};

void add_entry(Application& io, Kind kind, const std::string& name) {
  Global entry;
  entry.declared = {.name = name, .type = {kind, -1}, .file = io.project};
  entry.is_public = true;
  io.globals.push_back(std::move(entry));
}

bool is_in_io(const Expression& e) { return e.kind == Expression::Kind::kName && e.alias == "io"; }

/// "bIn20"; not "bIn020".
bool is_of_board(std::string_view name) {
  const auto word = std::ranges::find_if(kOfBoards, [&](auto one) { return name.starts_with(one); });
  if (word == kOfBoards.end()) return false;
  const std::string_view digits = name.substr(word->size());
  const bool is_number = !digits.empty() && digits.size() <= kBoardDigitsMax &&
                         std::ranges::all_of(digits, [](char c) { return c >= '0' && c <= '9'; });
  return is_number && (digits.size() == 1 || digits[0] != '0');
}

/// Names of the library io that a program tells what they are.
class NamedInIo {
 public:
  explicit NamedInIo(const Application& user) {
    for (const Program& program : user.programs)
      for (const Line& line : program.lines) {
        for (const Expression& e : line.expressions) expression(e);
        if (line.kind == Line::Kind::kAssign) assignment(user, program, line);
      }
  }
  std::set<std::string> signals;
  std::set<std::string> channels;

 private:
  void expression(const Expression& e) {
    if (is_in_io(e) && is_of_board(e.text)) signals.insert(e.text);
    const bool is_of_channel = e.kind == Expression::Kind::kCall &&
                               std::ranges::find(kChannelInstructions, e.text) != kChannelInstructions.end();
    for (const Expression& part : e.parts) {
      if (is_of_channel && is_in_io(part)) channels.insert(part.text);
      expression(part);
    }
  }

  /// What is set to a string, or what a string is set to, is a socket or a serial port.
  void assignment(const Application& user, const Program& program, const Line& line) {
    if (std::ranges::none_of(line.expressions,
                             [&](const Expression& e) { return is_text(user, program, e); }))
      return;
    for (const Expression& e : line.expressions)
      if (is_in_io(e)) channels.insert(e.text);
  }

  static bool is_text(const Application& user, const Program& program, const Expression& e) {
    switch (e.kind) {
      case Expression::Kind::kText:
        return true;
      case Expression::Kind::kBinary:
        return e.text == "+" && (is_text(user, program, e.parts[0]) || is_text(user, program, e.parts[1]));
      case Expression::Kind::kIndex:
        return is_text(user, program, e.parts[0]);
      case Expression::Kind::kCall: {
        const Instruction* const called = find_instruction(e.text);
        return called != nullptr && !called->signatures.empty() &&
               std::ranges::all_of(called->signatures,
                                   [](const Signature& one) { return one.result == Kind::kString; });
      }
      case Expression::Kind::kName:
        return e.alias.empty() && kind_of_name(user, program, e.text) == Kind::kString;
      default:
        return false;
    }
  }

  static Kind kind_of_name(const Application& user, const Program& program, const std::string& name) {
    for (const Declaration& local : program.locals)
      if (local.name == name) return local.type.kind;
    for (const Parameter& parameter : program.parameters)
      if (parameter.name == name) return parameter.type.kind;
    const int global = user.global_named(name);
    return global < 0 ? Kind::kVoid : user.globals[static_cast<std::size_t>(global)].declared.type.kind;
  }
};

}  // namespace

std::shared_ptr<Application> built_in_io(const Application& user) {
  auto io = std::make_shared<Application>();
  io->name = "io";
  io->project = "io";
  io->version = user.version;
  io->language = user.language;
  io->form = user.form;
  io->is_built_in = true;
  for (const auto& [word, first, count] : kNumbered)
    for (int i = first; i < first + count; ++i)
      add_entry(*io, Kind::kDio, std::string(word) + std::to_string(i));
  add_entry(*io, Kind::kDio, "SECTEUR_OK");
  for (const std::string_view name : kTemperatures) add_entry(*io, Kind::kAio, std::string(name));
  const NamedInIo named(user);
  for (const std::string& name : named.signals)
    if (io->global_named(name) < 0) add_entry(*io, Kind::kDio, name);
  for (const std::string& name : named.channels)
    if (io->global_named(name) < 0) add_entry(*io, Kind::kSio, name);
  link_to_signals(*io);
  return io;
}

void link_to_signals(Application& io) {
  for (Global& entry : io.globals) {
    const Kind kind = entry.declared.type.kind;
    const bool is_signal = kind == Kind::kDio || kind == Kind::kAio || kind == Kind::kSio;
    if (!is_signal || !entry.values.empty()) continue;
    const std::size_t size = entry.declared.sizes.size() == 1 ? entry.declared.sizes[0] : 0;
    for (std::size_t i = 0; i < size; ++i) {
      const std::string name =
          i == 0 ? entry.declared.name : entry.declared.name + '[' + std::to_string(i) + ']';
      entry.values.push_back({.index = {i},
                              .key = {},
                              .attributes = {{"link", name}},
                              .fields = {},
                              .line = entry.declared.line});
    }
  }
}

}  // namespace val3
