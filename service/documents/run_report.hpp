#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "service/documents/carried_json.hpp"
#include "service/documents/report_head.hpp"
#include "service/documents/result_document.hpp"
#include "service/documents/words.hpp"

namespace cell {

/// touchcal/report/1, of a calibration: the run, its result document and every touch with what became of it.
/// Distances are in mm along the outward normals; no value is unknown.
struct RunReport : ReportHead {
  struct Touch {
    int touch = 0;  // from 1
    int plane = 0;  // from 1
    calib::TouchRole role = calib::TouchRole::kFit;
    std::vector<std::string> joints_deg;  // to the last digit that came over the wire
    std::string source;
    std::string captured_at;
    std::optional<TouchUse> use;
    std::optional<double> nominal_mm;
    std::optional<double> calibrated_mm;

    template <class Self, class Fields>
    static void visit(Self& self, Fields& fields) {
      fields("touch", self.touch);
      fields("plane", self.plane);
      fields("role", self.role);
      fields("joints_deg", self.joints_deg);
      fields("source", self.source);
      fields("captured_at", self.captured_at);
      fields("use", self.use);
      fields("nominal_mm", self.nominal_mm);
      fields("calibrated_mm", self.calibrated_mm);
    }
  };
  struct Reference {
    int touches_done = 0;
    std::optional<double> drift_mm;  // against the first one
    std::string captured_at;

    template <class Self, class Fields>
    static void visit(Self& self, Fields& fields) {
      fields("touches_done", self.touches_done);
      fields("drift_mm", self.drift_mm);
      fields("captured_at", self.captured_at);
    }
  };

  /// A proof of this calibration that came to its end.
  struct ProofRun {
    std::string run;
    std::string ended_at;
    Verdict verdict = Verdict::kNone;

    template <class Self, class Fields>
    static void visit(Self& self, Fields& fields) {
      fields("run", self.run);
      fields("ended_at", self.ended_at);
      fields("verdict", self.verdict);
    }
  };

  std::string schema = "touchcal/report/1";
  std::vector<Touch> touches;
  std::vector<Reference> reference_touches;
  std::optional<Carried<ResultDocument>> result;
  std::vector<ProofRun> proofs;  // the oldest first

  template <class Self, class Fields>
  static void visit(Self& self, Fields& fields) {
    fields("schema", self.schema);
    ReportHead::visit(self, fields);
    fields("touches", self.touches);
    fields("reference_touches", self.reference_touches);
    fields("result", self.result);
    fields("proofs", self.proofs);
  }
};

std::string document_text(const RunReport& report);

/// DocumentError when the text is no report.
RunReport read_report(std::string_view text);

}  // namespace cell
