#pragma once

#include <optional>
#include <string>
#include <vector>

#include "service/documents/run_report.hpp"
#include "service/store/fault_log.hpp"
#include "service/store/run_store.hpp"

namespace cell {

/// All that is kept of a run. A report is made of this and of nothing else: it is the same whenever it is
/// made.
struct RunRecord {
  StoredRun run;
  std::vector<StoredTouch> touches;
  std::vector<SupersededTouch> superseded;
  std::vector<ReferenceTouch> references;
  std::vector<StoredFault> faults;
  std::optional<std::string> result_json;  // touchcal/result/1
};

/// touchcal/report/1, one JSON document as text.
std::string report_document(const RunRecord& record);

/// The touches as the controller answered them, a line each: number in the run, plane, role, six joint angles
/// in degrees to the last digit that came over the wire. `raw_data.sha256` of the report is taken over it.
std::string raw_data_text(const std::vector<StoredTouch>& touches);

/// The report's touches as a table for a spreadsheet; its first nine columns are raw_data_text().
std::string report_csv(const RunReport& report);

}  // namespace cell
