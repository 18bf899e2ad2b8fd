#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "calib_core/compensation/compensation.hpp"
#include "service/documents/words.hpp"

namespace cell {

/// Of targets of version 1, and of those of version 2, which may have straight lines.
inline constexpr std::string_view kFirstCompensatedSchema = "touchcal/compensated/1";
inline constexpr std::string_view kCompensatedSchema = "touchcal/compensated/2";

/// touchcal/compensated/1 or /2 (service/doc/surfaces.md).
struct CompensationDocument {
  struct Target {
    std::string name;
    calib::CompensationStatus status = calib::CompensationStatus::kRefused;
    std::optional<std::array<double, calib::kJointCount>> joints_deg;  // nothing when refused
    std::optional<double> moved_mm;
    std::optional<double> residual_um;
    std::optional<double> tip_uncertainty_mm;
    std::optional<std::string> reason;  // of a warning or a refusal
    // From version 2 on:
    std::optional<bool> inserted;  // a point that a straight line needs, not a target of the file
    /// At the end of a straight line how far the tool is off it at most; null where that is not known and of
    /// all others.
    std::optional<std::optional<double>> line_deviation_mm;

    template <class Self, class Fields>
    static void visit(Self& self, Fields& fields) {
      fields("name", self.name);
      fields("status", self.status);
      fields("joints_deg", self.joints_deg);
      fields("moved_mm", self.moved_mm);
      fields("residual_um", self.residual_um);
      fields("tip_uncertainty_mm", self.tip_uncertainty_mm);
      fields("reason", self.reason);
      fields.if_set("inserted", self.inserted);
      fields.if_set("line_deviation_mm", self.line_deviation_mm);
    }
  };

  /// The growth of the arm that was applied beside the model.
  struct Warmth {
    std::string check_run_id;
    std::string at;  // RFC 3339, the end of that check
    double growth_ppm = 0.0;

    template <class Self, class Fields>
    static void visit(Self& self, Fields& fields) {
      fields("check_run_id", self.check_run_id);
      fields("at", self.at);
      fields("growth_ppm", self.growth_ppm);
    }
  };

  /// The touched tool that was applied in place of its drawing.
  struct Touched {
    std::string from;  // the run, or the file
    std::array<double, 3> position_mm{};

    template <class Self, class Fields>
    static void visit(Self& self, Fields& fields) {
      fields("from", self.from);
      fields("position_mm", self.position_mm);
    }
  };

  std::string schema{kFirstCompensatedSchema};
  std::string model;               // SHA-256 of the calibrated arm, see arm_digest()
  std::optional<Warmth> warmth;    // nothing: as warm as at the calibration
  std::optional<Touched> touched;  // not there: the tool is as the cell's file has it
  std::vector<Target> targets;

  template <class Self, class Fields>
  static void visit(Self& self, Fields& fields) {
    fields("schema", self.schema);
    fields("model", self.model);
    fields("warmth", self.warmth);
    fields.if_set("touched", self.touched);
    fields("targets", self.targets);
  }

  /// The same without its targets.
  [[nodiscard]] CompensationDocument head() const;
  /// How many targets have this status.
  [[nodiscard]] int count(calib::CompensationStatus status) const;
  /// How many are points of straight lines.
  [[nodiscard]] int count_inserted() const;
};

std::string document_text(const CompensationDocument& document);

/// As lines "name,j1_deg,...,j6_deg", 9 decimals; a refused target keeps its line, with empty cells.
std::string compensated_csv(const CompensationDocument& document);

/// DocumentError when the text is no such document.
CompensationDocument read_compensation(std::string_view text);

}  // namespace cell
