#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "service/documents/carried_json.hpp"
#include "service/documents/verification_document.hpp"

namespace cell {

/// touchcal/qualification/1 (service/doc/surfaces.md): what the probe is like. No figure where there is no
/// verdict; what needs a calibrated arm is there only with one.
struct QualificationDocument {
  struct Scatter {
    std::optional<double> std_um;
    std::optional<double> degrees_of_freedom;
    std::optional<double> low_um;  // the true one is between these in 95 of 100
    std::optional<double> high_um;

    template <class Self, class Fields>
    static void visit(Self& self, Fields& fields) {
      fields("std_um", self.std_um);
      fields("degrees_of_freedom", self.degrees_of_freedom);
      fields("low_um", self.low_um);
      fields("high_um", self.high_um);
    }
  };
  /// Across the stylus, in R_7.
  struct Across {
    std::optional<double> size_mm;
    std::optional<double> std_mm;
    std::optional<double> direction_deg;  // from x to y; of a lobe

    template <class Self, class Fields>
    static void visit(Self& self, Fields& fields) {
      fields("size_mm", self.size_mm);
      fields("std_mm", self.std_mm);
      fields("direction_deg", self.direction_deg);
    }
  };
  struct Length {
    std::array<int, 2> planes{};  // from 1
    std::optional<double> known_mm;
    std::optional<double> error_mm;  // measured by the calibrated arm less known
    std::optional<double> std_mm;
    std::optional<double> p;  // of so large an error

    template <class Self, class Fields>
    static void visit(Self& self, Fields& fields) {
      fields("planes", self.planes);
      fields("known_mm", self.known_mm);
      fields("error_mm", self.error_mm);
      fields("std_mm", self.std_mm);
      fields("p", self.p);
    }
  };
  struct Criterion {
    std::string name;  // scatter, run_out, lobes, turns, stylus, length_3_5
    std::string unit;  // mm, or p: then the limit is the least
    std::optional<double> value;
    std::optional<double> limit;     // nothing: no limit in the cell's file
    std::optional<double> expanded;  // uncertainty of the value, k = 2
    bool passed = false;

    template <class Self, class Fields>
    static void visit(Self& self, Fields& fields) {
      fields("name", self.name);
      fields("unit", self.unit);
      fields("value", self.value);
      fields("limit", self.limit);
      fields("expanded", self.expanded);
      fields("passed", self.passed);
    }
  };
  struct TouchDeviation {
    int touch = 0;  // from 1
    int plane = 0;  // from 1
    std::optional<double> joint_6_deg;
    std::optional<double> deviation_mm;  // of a turn from the model, else from the face by the calibrated arm

    template <class Self, class Fields>
    static void visit(Self& self, Fields& fields) {
      fields("touch", self.touch);
      fields("plane", self.plane);
      fields("joint_6_deg", self.joint_6_deg);
      fields("deviation_mm", self.deviation_mm);
    }
  };

  std::string schema = "touchcal/qualification/1";
  std::string arm;
  std::string probe;
  std::optional<std::string> of_run;     // the calibration that it was held against
  std::optional<std::string> no_of_run;  // why there is none
  int touch_count = 0;
  bool complete = false;
  VerificationVerdict verdict;
  Scatter scatter;
  Across run_out;  // of the ball from where the cell's files have it
  Across lobes;    // of the pre-travel
  Across change;   // of the ball from where the calibrated arm has it
  std::vector<Length> lengths;
  std::vector<Criterion> criteria;
  std::vector<TouchDeviation> touches;
  std::optional<CarriedJson> conditions;

  template <class Self, class Fields>
  static void visit(Self& self, Fields& fields) {
    fields("schema", self.schema);
    fields("arm", self.arm);
    fields("probe", self.probe);
    fields("of_run", self.of_run);
    fields("no_of_run", self.no_of_run);
    fields("touch_count", self.touch_count);
    fields("complete", self.complete);
    fields("verdict", self.verdict);
    fields("scatter", self.scatter);
    fields("run_out", self.run_out);
    fields("lobes", self.lobes);
    fields("change", self.change);
    fields("lengths", self.lengths);
    fields("criteria", self.criteria);
    fields("touches", self.touches);
    fields("conditions", self.conditions);
  }
};

std::string document_text(const QualificationDocument& document);

/// DocumentError when the text is no such document.
QualificationDocument read_qualification(std::string_view text);

}  // namespace cell
