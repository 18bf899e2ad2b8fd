#include "sim_controller/val3/files/built_in_io.hpp"

#include <algorithm>
#include <array>
#include <set>
#include <string>
#include <string_view>

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
constexpr std::array<std::string_view, 2> kTemperatures{"CBT_TEMP", "CPU_TEMP"};
constexpr std::array<std::string_view, 5> kChannelInstructions{"sioLink", "sioGet", "sioSet", "sioCtrl",
                                                               "clearBuffer"};

void add_entry(Application& io, Kind kind, const std::string& name) {
  Global entry;
  entry.declared = {.name = name, .type = {kind, -1}, .file = io.project};
  entry.is_public = true;
  io.globals.push_back(std::move(entry));
}

/// Names of the library io among the arguments of instructions for sockets and serial ports.
void collect_channels(const Expression& e, std::set<std::string>& names) {
  const bool is_of_channel = e.kind == Expression::Kind::kCall &&
                             std::ranges::find(kChannelInstructions, e.text) != kChannelInstructions.end();
  for (const Expression& part : e.parts) {
    if (is_of_channel && part.kind == Expression::Kind::kName && part.alias == "io") names.insert(part.text);
    collect_channels(part, names);
  }
}

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
  std::set<std::string> channels;
  for (const Program& program : user.programs)
    for (const Line& line : program.lines)
      for (const Expression& e : line.expressions) collect_channels(e, channels);
  for (const std::string& name : channels)
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
