#include "sim_controller/val3_signals.hpp"

#include <algorithm>
#include <array>
#include <cctype>

#include "sim_controller/val3/program/signal_link.hpp"

namespace sim {
namespace {

bool is_digit(char c) { return std::isdigit(static_cast<unsigned char>(c)) != 0; }

/// "bIn12" with "bIn": "12".
std::optional<std::string_view> number_behind(std::string_view name, std::string_view prefix) {
  if (!name.starts_with(prefix)) return std::nullopt;
  name.remove_prefix(prefix.size());
  if (name.empty() || !std::all_of(name.begin(), name.end(), is_digit)) return std::nullopt;
  return name;
}

/// Cards that there is one of.
constexpr std::array<std::string_view, 6> kSingleCards{"FastIO", "UserIO",     "CpuIO",
                                                       "RsiIO",  "PtCFaultIO", "ValveIO"};
/// ... and those that are counted: BasicIO-2, ModbusSrv-0, EncoderIO1.
constexpr std::array<std::string_view, 3> kCountedCards{"BasicIO-", "ModbusSrv-", "EncoderIO"};

bool level_of(CellSignal signal, const Cabinet& cabinet) {
  switch (signal) {
    case CellSignal::kContact:
      return cabinet.world.probe.inputs.contact;
    case CellSignal::kLoop:
      return cabinet.world.probe.inputs.loop;
    case CellSignal::kClosed:
      return cabinet.panel.cell_closed;
    case CellSignal::kConfirm:
      return cabinet.panel.confirm_key;
  }
  return false;
}

using SignalIds = std::map<std::string, int, std::less<>>;

std::optional<int> known_in(const SignalIds& ids, std::string_view link) {
  const auto known = ids.find(signal_name(link));
  return known == ids.end() ? std::nullopt : std::optional(known->second);
}

template <class Kind, class Make>
std::optional<int> find_or_make(std::string_view link, const CardNames& cards, SignalIds& ids,
                                std::vector<Kind>& all, const Make& make) {
  if (link.empty() || missing_card(link, cards)) return std::nullopt;
  const std::string name = signal_name(link);
  if (const auto known = ids.find(name); known != ids.end()) return known->second;
  if (all.size() >= Val3Signals::kSignalsMax) return std::nullopt;
  const int id = static_cast<int>(all.size());
  all.push_back(make(name));
  ids.emplace(name, id);
  return id;
}

}  // namespace

std::string signal_name(std::string_view link) {
  constexpr std::string_view kLibrary = "io:";
  if (link.starts_with(kLibrary)) link.remove_prefix(kLibrary.size());
  std::string name(link);
  if (name.find('\\') != std::string::npos) return name;
  if (const auto number = number_behind(name, "bIn")) return "BasicIO-1\\%I" + std::string(*number);
  if (const auto number = number_behind(name, "bOut")) return "BasicIO-1\\%Q" + std::string(*number);
  if (number_behind(name, "fIn") || number_behind(name, "fOut")) return "FastIO\\" + name;
  if (number_behind(name, "usrIn")) return "UserIO\\" + name;
  return name;
}

std::optional<std::string> missing_card(std::string_view link, const CardNames& more) {
  const std::size_t slash = link.find('\\');
  if (slash == std::string_view::npos) return std::nullopt;
  const std::string_view card = link.substr(0, slash);
  const bool is_counted = std::ranges::any_of(
      kCountedCards, [card](std::string_view prefix) { return number_behind(card, prefix).has_value(); });
  if (is_counted || card == "EncoderIO" || std::ranges::count(kSingleCards, card) != 0 || more.contains(card))
    return std::nullopt;
  return std::string(card);
}

CellLinks touchcal_links() {
  return {{"FastIO\\fIn0", CellSignal::kContact},
          {"BasicIO-1\\%I0", CellSignal::kLoop},
          {"BasicIO-1\\%I1", CellSignal::kClosed},
          {"BasicIO-1\\%I2", CellSignal::kConfirm}};
}

std::optional<int> Val3Signals::find_digital(std::string_view link) {
  return find_or_make(link, cards_, digital_ids_, digitals_, [this](const std::string& name) {
    Digital made{.link = name, .is_input = val3::names_input(name)};
    made.has_latch = name == "FastIO\\fIn0" || name == "FastIO\\fIn1";
    if (const auto of_cell = links_.find(name); of_cell != links_.end()) {
      made.of_cell = of_cell->second;
      made.is_input = true;
    }
    return made;
  });
}

std::optional<int> Val3Signals::find_analogue(std::string_view link) {
  return find_or_make(link, cards_, analogue_ids_, analogues_, [](const std::string& name) {
    return Analogue{.link = name, .is_input = val3::names_input(name)};
  });
}

bool Val3Signals::digital(int id, const Cabinet& cabinet) const {
  const Digital& signal = at(id);
  return signal.of_cell ? level_of(*signal.of_cell, cabinet) : signal.on;
}

val3::RunError Val3Signals::write(int id, bool on) {
  Digital& signal = digitals_.at(static_cast<std::size_t>(id));
  if (signal.is_input) return val3::kErrorWriteToInput;
  signal.on = on;
  return val3::kErrorNone;
}

val3::RunError Val3Signals::write(int id, double value) {
  Analogue& signal = analogues_.at(static_cast<std::size_t>(id));
  if (signal.is_input) return val3::kErrorWriteToInput;
  signal.value = value;
  return val3::kErrorNone;
}

std::optional<int> Val3Signals::known_digital(std::string_view link) const {
  return known_in(digital_ids_, link);
}

bool Val3Signals::set(std::string_view link, bool on) {
  const auto id = known_digital(link);
  if (!id || at(*id).of_cell) return false;
  digitals_[static_cast<std::size_t>(*id)].on = on;
  return true;
}

bool Val3Signals::set(std::string_view link, double value) {
  const auto id = known_in(analogue_ids_, link);
  if (!id) return false;
  analogues_[static_cast<std::size_t>(*id)].value = value;
  return true;
}

}  // namespace sim
