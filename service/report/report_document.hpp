#pragma once

#include <optional>
#include <string>
#include <vector>

#include "service/documents/run_report.hpp"
#include "service/store/fault_log.hpp"
#include "service/store/refused_result.hpp"
#include "service/store/run_store.hpp"

namespace cell {

/// Everything stored about a run. A report depends on nothing else, so it can be repeated.
struct RunRecord {
  StoredRun run;
  std::vector<StoredTouch> touches;
  std::vector<SupersededTouch> superseded;
  std::vector<ReferenceTouch> references;
  std::vector<RefusedResult> refused;
  std::vector<StoredFault> faults;
  std::optional<std::string> result_json;  // touchcal/result/1
  std::vector<StoredRun> proofs = {};      // of a calibration: those that came to their end
};

/// touchcal/report/1, one JSON document as text.
std::string report_document(const RunRecord& record);

/// The touches as answered by the controller, one line each: number in the run, plane, role, six joint angles
/// in degrees with every digit of the wire. `raw_data.sha256` of the report is the digest of this text.
std::string raw_data_text(const std::vector<StoredTouch>& touches);

/// The touches as CSV; the first nine columns are raw_data_text().
std::string report_csv(const RunReport& report);

}  // namespace cell
