#pragma once

#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "service/store/fault_log.hpp"
#include "service/store/run_store.hpp"

namespace cell {

/// Everything stored about a run. A report depends on nothing else, so it can be repeated.
struct RunRecord {
  StoredRun run;
  std::vector<StoredTouch> touches;
  std::vector<SupersededTouch> superseded;
  std::vector<ReferenceTouch> references;
  std::vector<StoredFault> faults;
  std::optional<std::string> result_json;  // touchcal/result/1
};

/// touchcal/report/1: the run, its result document and every touch with its use. Joints are in degrees,
/// distances in mm along the outward normals; null is unknown.
nlohmann::ordered_json report_json(const RunRecord& record);

/// The touches as answered by the controller, one line each: number in the run, plane, role, six joint angles
/// in degrees with every digit of the wire. `raw_data.sha256` of the report is the digest of this text.
std::string raw_data_text(const std::vector<StoredTouch>& touches);

/// The touches as CSV; the first nine columns are raw_data_text().
std::string report_csv(const nlohmann::ordered_json& report);

}  // namespace cell
