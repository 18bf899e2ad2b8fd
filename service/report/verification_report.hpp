#pragma once

#include <optional>
#include <string>
#include <vector>

#include "service/documents/verification_report.hpp"
#include "service/report/report_document.hpp"

namespace cell {

/// Everything stored about a proof or a check, and of the calibration that it is of. Its report depends on
/// nothing else.
struct VerificationRecord {
  RunRecord own;
  std::string cell;                      // its name
  std::optional<StoredRun> calibration;  // nothing where it is no longer stored
  std::vector<StoredTouch> calibration_touches;
  std::optional<ChecksDocument> checks = {};  // of a check: those of the calibration up to this one
};

/// touchcal/verification-report/1, one JSON document as text.
std::string verification_report_document(const VerificationRecord& record);

/// The touches as CSV; the first nine columns are raw_data_text().
std::string verification_report_csv(const VerificationReport& report);

}  // namespace cell
