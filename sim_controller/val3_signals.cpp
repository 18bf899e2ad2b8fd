#include "sim_controller/val3_signals.hpp"

#include <algorithm>
#include <cctype>

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

/// The names of s5 and s6 as those of s7: there a signal stands without its card.
std::string with_card(std::string_view link) {
  std::string name(link);
  if (name.find('\\') != std::string::npos) return name;
  if (const auto number = number_behind(name, "bIn")) return "BasicIO-1\\%I" + std::string(*number);
  if (const auto number = number_behind(name, "bOut")) return "BasicIO-1\\%Q" + std::string(*number);
  if (number_behind(name, "fIn") || number_behind(name, "fOut")) return "FastIO\\" + name;
  if (number_behind(name, "usrIn")) return "UserIO\\" + name;
  return name;
}

/// "%I0", "%IW0", "fIn0", "usrIn1", a name that ends in In or In and a number.
bool reads_as_input(std::string_view link) {
  const std::size_t slash = link.rfind('\\');
  std::string_view name = slash == std::string_view::npos ? link : link.substr(slash + 1);
  if (name.starts_with("%I")) return true;
  while (!name.empty() && is_digit(name.back())) name.remove_suffix(1);
  return name.ends_with("In");
}

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

template <class Kind, class Make>
std::optional<int> find_or_make(std::string_view link, std::map<std::string, int, std::less<>>& ids,
                                std::vector<Kind>& all, const Make& make) {
  if (link.empty()) return std::nullopt;
  const std::string name = with_card(link);
  if (const auto known = ids.find(name); known != ids.end()) return known->second;
  if (all.size() >= Val3Signals::kSignalsMax) return std::nullopt;
  const int id = static_cast<int>(all.size());
  all.push_back(make(name));
  ids.emplace(name, id);
  return id;
}

}  // namespace

CellLinks touchcal_links() {
  return {{"FastIO\\fIn0", CellSignal::kContact},
          {"BasicIO-1\\%I0", CellSignal::kLoop},
          {"BasicIO-1\\%I1", CellSignal::kClosed},
          {"BasicIO-1\\%I2", CellSignal::kConfirm}};
}

std::optional<int> Val3Signals::find_digital(std::string_view link) {
  return find_or_make(link, digital_ids_, digitals_, [this](const std::string& name) {
    Digital made{.link = name, .is_input = reads_as_input(name)};
    made.has_latch = name == "FastIO\\fIn0" || name == "FastIO\\fIn1";
    if (const auto of_cell = links_.find(name); of_cell != links_.end()) {
      made.of_cell = of_cell->second;
      made.is_input = true;
    }
    return made;
  });
}

std::optional<int> Val3Signals::find_analogue(std::string_view link) {
  return find_or_make(link, analogue_ids_, analogues_, [](const std::string& name) {
    return Analogue{.link = name, .is_input = reads_as_input(name)};
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

bool Val3Signals::set(std::string_view link, bool on) {
  const auto id = find_digital(link);
  if (!id || at(*id).of_cell) return false;
  digitals_[static_cast<std::size_t>(*id)].on = on;
  return true;
}

bool Val3Signals::set(std::string_view link, double value) {
  const auto id = find_analogue(link);
  if (!id) return false;
  analogues_[static_cast<std::size_t>(*id)].value = value;
  return true;
}

}  // namespace sim
