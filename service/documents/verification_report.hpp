#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "service/documents/carried_json.hpp"
#include "service/documents/checks_document.hpp"
#include "service/documents/conditions_document.hpp"
#include "service/documents/report_head.hpp"
#include "service/documents/words.hpp"

namespace cell {

/// touchcal/verification-report/1, of a proof or a check: the run, the calibration that it is of, every touch
/// with its deviation, and the result as stored.
struct VerificationReport : ReportHead {
  /// Of the calibration only its number is known where it is no longer stored.
  struct Calibration {
    std::optional<std::string> id;
    std::optional<std::string> recipe;
    std::optional<std::string> started_at;
    std::optional<std::string> ended_at;
    std::optional<Verdict> verdict;
    std::optional<std::string> raw_data_sha256;

    template <class Self, class Fields>
    static void visit(Self& self, Fields& fields) {
      fields("id", self.id);
      fields("recipe", self.recipe);
      fields("started_at", self.started_at);
      fields("ended_at", self.ended_at);
      fields("verdict", self.verdict);
      fields("raw_data_sha256", self.raw_data_sha256);
    }
  };
  struct Touch {
    int touch = 0;  // from 1
    int plane = 0;  // from 1
    calib::TouchRole role = calib::TouchRole::kFit;
    std::vector<std::string> joints_deg;  // to the last digit that came over the wire
    std::string source;
    std::string captured_at;
    /// Of a proof the distance from the block, of a check the change of the distance since the reference.
    std::optional<double> deviation_mm;

    template <class Self, class Fields>
    static void visit(Self& self, Fields& fields) {
      fields("touch", self.touch);
      fields("plane", self.plane);
      fields("role", self.role);
      fields("joints_deg", self.joints_deg);
      fields("source", self.source);
      fields("captured_at", self.captured_at);
      fields("deviation_mm", self.deviation_mm);
    }
  };

  std::string schema = "touchcal/verification-report/1";
  std::string kind;  // proof, check, qualification
  std::string cell;
  Calibration calibration;
  std::vector<Touch> touches;
  std::optional<Carried<ConditionsDocument>> conditions;  // as stored when the run started
  std::optional<CarriedJson> result;                      // of the kind, as stored
  std::optional<ChecksDocument> checks;  // of a check: those of its calibration up to this one

  template <class Self, class Fields>
  static void visit(Self& self, Fields& fields) {
    fields("schema", self.schema);
    fields("kind", self.kind);
    fields("cell", self.cell);
    ReportHead::visit(self, fields);
    fields("calibration", self.calibration);
    fields("touches", self.touches);
    fields("conditions", self.conditions);
    fields("result", self.result);
    fields("checks", self.checks);
  }
};

std::string document_text(const VerificationReport& report);

/// DocumentError when the text is no such report.
VerificationReport read_verification_report(std::string_view text);

}  // namespace cell
