#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "service/http/routes.hpp"
#include "service/store/touch_store.hpp"

namespace cell {

/// GET runs/{id}/result of a run that is in the store: touchcal/result/1; 409 before there is a result.
HttpResponse get_result(const CellOperation& operation, std::int64_t id);

/// GET runs/{id}/arm: the calibrated arm as a file of schema touchcal/arm/1; 409 before there is a result, or
/// when the cell is no longer the one that the run was made in.
HttpResponse get_arm(const CellOperation& operation, std::int64_t id);

inline constexpr std::string_view kHtml = "text/html; charset=utf-8";
inline constexpr std::string_view kCsv = "text/csv; charset=utf-8";

/// GET runs/{id}/report: touchcal/report/1 as a page for people ("html"), a table of touches ("csv") or
/// itself
/// ("json"); 400 for another format.
HttpResponse get_report(const CellOperation& operation, const StoredRun& run, const std::string& format);

}  // namespace cell
