#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "service/documents/words.hpp"

namespace cell {

/// The distances of one role's touches of a plane, along its outward normal from the block's origin.
struct PlaneDistances {
  int plane = 0;                     // from 1
  std::optional<std::string> place;  // another one than the first
  std::optional<std::string> tip;    // that touched it; another one than the first
  int touch_count = 0;
  std::optional<double> reference_mm;
  std::optional<double> estimated_offset_mm;  // of a face that was found in place
  std::optional<double> nominal_mean_mm;
  std::optional<double> calibrated_mean_mm;
  std::optional<double> error_removed_percent;
  std::optional<double> nominal_agreement_percent;
  std::optional<double> nominal_rms_mm;
  std::optional<double> calibrated_rms_mm;

  template <class Self, class Fields>
  static void visit(Self& self, Fields& fields) {
    fields("plane", self.plane);
    fields.if_set("place", self.place);
    fields.if_set("tip", self.tip);
    fields("touch_count", self.touch_count);
    fields("reference_mm", self.reference_mm);
    fields("estimated_offset_mm", self.estimated_offset_mm);
    fields("nominal_mean_mm", self.nominal_mean_mm);
    fields("calibrated_mean_mm", self.calibrated_mean_mm);
    fields("error_removed_percent", self.error_removed_percent);
    fields("nominal_agreement_percent", self.nominal_agreement_percent);
    fields("nominal_rms_mm", self.nominal_rms_mm);
    fields("calibrated_rms_mm", self.calibrated_rms_mm);
  }
};

/// An identification that began at the calibrated arm: the errors that it still found.
struct RepetitionDocument {
  struct NewError {
    std::string name;
    int frame = 0;
    std::string kind;
    std::string unit;
    std::optional<calib::ParameterStatus> status;
    std::optional<double> new_error;
    std::optional<double> std_new_error;

    template <class Self, class Fields>
    static void visit(Self& self, Fields& fields) {
      fields("name", self.name);
      fields("frame", self.frame);
      fields("kind", self.kind);
      fields("unit", self.unit);
      fields("status", self.status);
      fields("new_error", self.new_error);
      fields("std_new_error", self.std_new_error);
    }
  };

  bool done = false;
  std::optional<std::string> why_not;
  int touch_count = 0;
  int iterations = 0;
  std::optional<double> new_error_max_si;
  std::vector<NewError> parameters;

  template <class Self, class Fields>
  static void visit(Self& self, Fields& fields) {
    fields("done", self.done);
    fields("why_not", self.why_not);
    fields("touch_count", self.touch_count);
    fields("iterations", self.iterations);
    fields("new_error_max_si", self.new_error_max_si);
    fields("parameters", self.parameters);
  }
};

/// With the same touches the new errors have a limit.
struct SameTouchesDocument : RepetitionDocument {
  std::optional<double> limit_si;
  bool passed = false;

  template <class Self, class Fields>
  static void visit(Self& self, Fields& fields) {
    RepetitionDocument::visit(self, fields);
    fields("limit_si", self.limit_si);
    fields("passed", self.passed);
  }
};

/// B.1 and B.2: `validation` of a result.
struct RepetitionsDocument {
  SameTouchesDocument same_touches;
  RepetitionDocument other_touches;

  template <class Self, class Fields>
  static void visit(Self& self, Fields& fields) {
    fields("same_touches", self.same_touches);
    fields("other_touches", self.other_touches);
  }
};

/// touchcal/validation/1.
struct ValidationDocument {
  std::string schema = "touchcal/validation/1";
  std::string arm;
  std::string recipe;
  int touch_count = 0;
  int identifiable_count = 0;
  std::vector<std::string> warnings;
  RepetitionsDocument repetitions;
  std::vector<PlaneDistances> planes;
  std::vector<PlaneDistances> planes_held_out;

  template <class Self, class Fields>
  static void visit(Self& self, Fields& fields) {
    fields("schema", self.schema);
    fields("arm", self.arm);
    fields("recipe", self.recipe);
    fields("touch_count", self.touch_count);
    fields("identifiable_count", self.identifiable_count);
    fields("warnings", self.warnings);
    RepetitionsDocument::visit(self.repetitions, fields);
    fields("planes", self.planes);
    fields("planes_held_out", self.planes_held_out);
  }
};

std::string document_text(const ValidationDocument& document);

/// DocumentError when the text is no such document.
ValidationDocument read_validation(std::string_view text);

}  // namespace cell
