#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "service/documents/carried_json.hpp"
#include "service/documents/verification_document.hpp"

namespace cell {

/// touchcal/tool/1 (service/doc/surfaces.md): where the tip of a tool is on the calibrated arm of a run, from
/// touches of the block with that tip. Positions are in R_6, whose origin is the wrist's centre. No figure
/// where there is no verdict.
struct ToolDocument {
  /// Of the arm with this tool, beside those of the calibration.
  struct ArmError {
    std::string name;  // "alpha6"
    std::string unit;  // mm or rad
    double error = 0.0;

    template <class Self, class Fields>
    static void visit(Self& self, Fields& fields) {
      fields("name", self.name);
      fields("unit", self.unit);
      fields("error", self.error);
    }
  };

  std::string schema = "touchcal/tool/1";
  std::string arm;
  std::string tool;
  std::string of_run;
  int touch_count = 0;
  bool complete = false;
  VerificationVerdict verdict;
  std::array<double, 3> drawn_mm{};  // by the cell's file
  std::optional<std::array<double, 3>> position_mm;
  std::optional<std::array<double, 3>> std_position_mm;
  std::optional<double> off_drawing_mm;
  std::vector<ArmError> arm_errors;
  std::optional<double> box_rms_mm;        // predicted error of the touched tip over the workspace box
  std::optional<double> world_box_rms_mm;  // the same in the controller's world
  std::optional<double> box_rms_max_mm;
  std::optional<double> rms_mm;  // of the touches from their planes
  std::optional<double> chi_square;
  std::optional<double> degrees_of_freedom;
  std::optional<double> p;
  std::optional<double> p_min;
  std::vector<ProofDocument::TouchDistance> touches;
  std::optional<CarriedJson> conditions;

  template <class Self, class Fields>
  static void visit(Self& self, Fields& fields) {
    fields("schema", self.schema);
    fields("arm", self.arm);
    fields("tool", self.tool);
    fields("of_run", self.of_run);
    fields("touch_count", self.touch_count);
    fields("complete", self.complete);
    fields("verdict", self.verdict);
    fields("drawn_mm", self.drawn_mm);
    fields("position_mm", self.position_mm);
    fields("std_position_mm", self.std_position_mm);
    fields("off_drawing_mm", self.off_drawing_mm);
    fields("arm_errors", self.arm_errors);
    fields("box_rms_mm", self.box_rms_mm);
    fields("world_box_rms_mm", self.world_box_rms_mm);
    fields("box_rms_max_mm", self.box_rms_max_mm);
    fields("rms_mm", self.rms_mm);
    fields("chi_square", self.chi_square);
    fields("degrees_of_freedom", self.degrees_of_freedom);
    fields("p", self.p);
    fields("p_min", self.p_min);
    fields("touches", self.touches);
    fields("conditions", self.conditions);
  }
};

std::string document_text(const ToolDocument& document);

/// DocumentError when the text is no such document.
ToolDocument read_tool(std::string_view text);

}  // namespace cell
