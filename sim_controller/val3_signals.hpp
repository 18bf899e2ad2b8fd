#pragma once

#include <cstddef>
#include <map>
#include <optional>
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

/// Digital and analogue inputs and outputs by link. Any link that is asked for is there: those of the cell
/// read the cabinet, any other is a level that a program writes (an output) or a script sets (an input).
/// Inputs keep their level through a tick, as the cabinet changes between ticks only.
class Val3Signals {
 public:
  explicit Val3Signals(CellLinks links) : links_(std::move(links)) {}

  /// "FastIO\fIn0"; of s5 and s6 "fIn0", "bIn3" (BasicIO-1\%I3). Nothing for an empty link, and beyond
  /// kSignalsMax.
  std::optional<int> find_digital(std::string_view link);
  std::optional<int> find_analogue(std::string_view link);

  [[nodiscard]] bool digital(int id, const Cabinet& cabinet) const;
  /// kErrorWriteToInput for an input.
  val3::RunError write(int id, bool on);
  [[nodiscard]] double analogue(int id) const { return analogues_.at(static_cast<std::size_t>(id)).value; }
  val3::RunError write(int id, double value);

  /// A script's hand on a level. False where it is a signal of the cell, or no link.
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
  std::vector<Digital> digitals_;
  std::vector<Analogue> analogues_;
  std::map<std::string, int, std::less<>> digital_ids_;
  std::map<std::string, int, std::less<>> analogue_ids_;
};

}  // namespace sim
