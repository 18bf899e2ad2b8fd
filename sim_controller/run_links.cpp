#include "sim_controller/run_links.hpp"

#include <spdlog/fmt/fmt.h>

namespace sim {
namespace {

/// Names that a message lists.
constexpr std::size_t kNamesTold = 40;

/// Collects the links of data.
class LinkReader {
 public:
  LinkReader(RunLinks& links, const CardNames& cards) : links_(links), cards_(cards) {}

  void read(const val3::Application& application) {
    for (const val3::Global& global : application.globals) read(global.declared, global.values);
    for (const val3::Library& library : application.libraries)
      if (library.application) read(*library.application);
  }

 private:
  void read(const val3::Declaration& declared, const std::vector<val3::StoredValue>& values) {
    const val3::Kind kind = declared.type.kind;
    for (const val3::StoredValue& value : values) {
      if (kind == val3::Kind::kDio) add(declared, value, "link", links_.digital);
      if (kind == val3::Kind::kAio) add(declared, value, "link", links_.analogue);
      if (kind == val3::Kind::kTool) add(declared, value, "ioLink", links_.digital);
      for (const val3::StoredField& field : value.fields) read(field.declared, field.values);
    }
  }

  void add(const val3::Declaration& declared, const val3::StoredValue& value, const char* attribute,
           std::set<std::string>& names) {
    const auto link = value.attributes.find(attribute);
    if (link == value.attributes.end() || link->second.empty()) return;
    const auto card = missing_card(link->second, cards_);
    if (!card) {
      names.insert(signal_name(link->second));
      return;
    }
    links_.not_there.push_back(
        fmt::format("{}:{}: {} is linked to {}, and there is no card {}: it is not linked, its use is error "
                    "123; mend the link, or let the script of --run begin with '0 card {}'",
                    declared.file, value.line, declared.name, link->second, *card, *card));
  }

  RunLinks& links_;
  const CardNames& cards_;
};

std::string list_of(const std::set<std::string>& names) {
  std::string all;
  std::size_t told = 0;
  for (const std::string& name : names) {
    if (++told > kNamesTold) return all + fmt::format(" and {} more", names.size() - kNamesTold);
    all += (all.empty() ? "" : ", ") + name;
  }
  return all;
}

}  // namespace

RunLinks links_of(const val3::Application& application, const CardNames& cards) {
  RunLinks links;
  for (const auto& [link, signal] : touchcal_links()) links.digital.insert(link);
  LinkReader reader(links, cards);
  reader.read(application);
  return links;
}

CardNames cards_of(std::span<const ScriptStep> steps) {
  CardNames cards;
  for (const ScriptStep& step : steps) {
    if (step.act.kind == ScriptAct::Kind::kCard) cards.insert(step.act.name);
  }
  return cards;
}

std::optional<ScriptError> unknown_signal(std::span<const ScriptStep> steps, const RunLinks& links) {
  for (const ScriptStep& step : steps) {
    const bool is_analogue = step.act.kind == ScriptAct::Kind::kAnalogue;
    if (!is_analogue && step.act.kind != ScriptAct::Kind::kInput &&
        step.act.kind != ScriptAct::Kind::kExpectOutput)
      continue;
    const std::set<std::string>& names = is_analogue ? links.analogue : links.digital;
    if (names.contains(signal_name(step.act.name))) continue;
    const char* const kind = is_analogue ? "analogue" : "digital";
    return ScriptError{
        step.line,
        fmt::format("'{}' is no {} input or output of the application; {}", step.act.name, kind,
                    names.empty() ? "it has none, leave the line out" : "there are: " + list_of(names))};
  }
  return std::nullopt;
}

}  // namespace sim
