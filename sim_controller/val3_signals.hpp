#pragma once

#include <cstddef>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "sim_controller/cabinet.hpp"
#include "sim_controller/val3/machine/system.hpp"

namespace sim {

/// What the cell itself is wired to the controller with.
enum class CellSignal { kContact, kLoop, kClosed, kConfirm };

/// Which link is which signal of the cell.
using CellLinks = std::map<std::string, CellSignal, std::less<>>;
/// As INSTALL.md of the application wires them.
CellLinks touchcal_links();

/// Cards beside those that a CS8 or CS8C has by itself (configs/systemios.cfx): of fieldbuses.
using CardNames = std::set<std::string, std::less<>>;

/// A link as s7 writes it: "fIn0", "bIn3", "usrIn0" of s5 and s6 stand without their card, or behind their
/// library "io:".
std::string signal_name(std::string_view link);
/// The card of a link that neither a controller nor `more` has; nothing where it is there, or the link names
/// no card: then it is a system signal.
std::optional<std::string> missing_card(std::string_view link, const CardNames& more);

/// Digital and analogue inputs and outputs by link. Any link of a card that is there can be asked for: those
/// of the cell read the cabinet, any other is a level that a program writes (an output) or a script sets (an
/// input).
/// Inputs keep their level through a tick, as the cabinet changes between ticks only.
class Val3Signals {
 public:
  explicit Val3Signals(CellLinks links, CardNames cards = {})
      : links_(std::move(links)), cards_(std::move(cards)) {}

  /// "FastIO\fIn0"; of s5 and s6 "fIn0", "bIn3" (BasicIO-1\%I3). Nothing for an empty link, for a card that
  /// is not there (its signals are not linked), and beyond kSignalsMax.
  std::optional<int> find_digital(std::string_view link);
  std::optional<int> find_analogue(std::string_view link);

  [[nodiscard]] bool digital(int id, const Cabinet& cabinet) const;
  /// kErrorWriteToInput for an input.
  val3::RunError write(int id, bool on);
  [[nodiscard]] double analogue(int id) const { return analogues_.at(static_cast<std::size_t>(id)).value; }
  val3::RunError write(int id, double value);

  /// A digital signal that was found before.
  [[nodiscard]] std::optional<int> known_digital(std::string_view link) const;
  /// A script's hand on a level. False where it is a signal of the cell, or none that was found before.
  bool set(std::string_view link, bool on);
  bool set(std::string_view link, double value);
  /// A rising edge on it can be latched: FastIO\fIn0 and fIn1 (manual 6, page 111).
  [[nodiscard]] bool has_latch(int id) const { return at(id).has_latch; }
  [[nodiscard]] std::optional<CellSignal> cell_signal(int id) const { return at(id).of_cell; }

  static constexpr std::size_t kSignalsMax = 20'000;

 private:
  struct Digital {
    std::string link;
    std::optional<CellSignal> of_cell;
    bool is_input = false;
    bool has_latch = false;
    bool on = false;
  };
  struct Analogue {
    std::string link;
    bool is_input = false;
    double value = 0.0;
  };
  [[nodiscard]] const Digital& at(int id) const { return digitals_.at(static_cast<std::size_t>(id)); }

  CellLinks links_;
  CardNames cards_;
  std::vector<Digital> digitals_;
  std::vector<Analogue> analogues_;
  std::map<std::string, int, std::less<>> digital_ids_;
  std::map<std::string, int, std::less<>> analogue_ids_;
};

}  // namespace sim
