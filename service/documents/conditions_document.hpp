#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>

namespace cell {

/// `place` of the cell and of a run: where the block was located, against the cell's file.
struct PlaceDocument {
  std::string located_at;
  std::array<double, 3> shift_mm{};
  std::array<double, 3> std_shift_mm{};
  std::array<double, 3> turn_deg{};  // rotation vector
  std::array<double, 3> std_turn_deg{};
  std::uint64_t touch_count = 0;

  bool operator==(const PlaceDocument&) const = default;

  template <class Self, class Fields>
  static void visit(Self& self, Fields& fields) {
    fields("located_at", self.located_at);
    fields("shift_mm", self.shift_mm);
    fields("std_shift_mm", self.std_shift_mm);
    fields("turn_deg", self.turn_deg);
    fields("std_turn_deg", self.std_turn_deg);
    fields("touch_count", self.touch_count);
  }
};

/// `conditions` of a run and of a result; no value is unknown.
struct ConditionsDocument {
  struct Certified {
    std::string name;
    std::optional<std::string> serial;
    std::optional<std::map<std::string, std::string>> certificate;

    template <class Self, class Fields>
    static void visit(Self& self, Fields& fields) {
      fields("name", self.name);
      fields("serial", self.serial);
      fields("certificate", self.certificate);
    }
  };
  struct Versions {
    std::string touchcal;
    std::optional<int> protocol;
    std::optional<std::string> controller_application;

    template <class Self, class Fields>
    static void visit(Self& self, Fields& fields) {
      fields("touchcal", self.touchcal);
      fields("protocol", self.protocol);
      fields("controller_application", self.controller_application);
    }
  };

  /// The qualification before the run whose repeats count among its own.
  struct Qualification {
    std::string run_id;
    double scatter_um = 0.0;
    double degrees_of_freedom = 0.0;

    template <class Self, class Fields>
    static void visit(Self& self, Fields& fields) {
      fields("run_id", self.run_id);
      fields("scatter_um", self.scatter_um);
      fields("degrees_of_freedom", self.degrees_of_freedom);
    }
  };

  std::optional<std::string> operator_name;
  std::optional<std::string> config_digest;
  std::optional<double> block_temperature_c;
  std::optional<double> std_temperature_k;
  std::optional<double> thermal_expansion_per_k;
  std::optional<std::string> block_temperature_source;  // file, run
  std::optional<std::string> block_temperature_at;      // when it was measured
  std::optional<double> arm_moving_min;                 // before the run
  std::optional<std::string> arm_serial;                // of this very robot
  std::optional<std::string> controller_serial;
  Certified block;
  Certified probe;
  Versions versions;
  std::optional<std::int64_t> controller_session;
  std::optional<std::string> touch_mode;
  /// Null: the block stood where the cell's file has it. Not there: an older daemon did not say.
  std::optional<std::optional<PlaceDocument>> place;
  std::optional<std::optional<Qualification>> qualification;  // likewise; null: none that counts
  /// The tool that touched in place of the probe; null or not there: none.
  std::optional<std::optional<std::string>> tool;

  template <class Self, class Fields>
  static void visit(Self& self, Fields& fields) {
    fields("operator", self.operator_name);
    fields("config_digest", self.config_digest);
    fields("block_temperature_c", self.block_temperature_c);
    fields("std_temperature_k", self.std_temperature_k);
    fields("thermal_expansion_per_k", self.thermal_expansion_per_k);
    fields("block_temperature_source", self.block_temperature_source);
    fields("block_temperature_at", self.block_temperature_at);
    fields("arm_moving_min", self.arm_moving_min);
    fields("arm_serial", self.arm_serial);
    fields("controller_serial", self.controller_serial);
    fields("block", self.block);
    fields("probe", self.probe);
    fields("versions", self.versions);
    fields("controller_session", self.controller_session);
    fields("touching", self.touch_mode);
    fields("place", self.place);
    fields("qualification", self.qualification);
    fields("tool", self.tool);
  }
};

std::string document_text(const ConditionsDocument& document);

/// Of stored conditions, also those of an older daemon. DocumentError when the text is no such document.
ConditionsDocument read_conditions(std::string_view text);

/// `touching` of stored conditions; nothing when they do not say or are no document.
std::optional<std::string> touching_of(std::string_view conditions);

}  // namespace cell
