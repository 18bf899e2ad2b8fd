#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "service/http/routes/reads.hpp"
#include "service/http/routes/routes.hpp"
#include "service/store/run_store.hpp"

namespace cell {

/// GET runs/{id}/result of a stored run: touchcal/result/1, as it was stored when the run ended. 409 before
/// there is a result, and for a run without a stored one when the cell's files or the block's place are not
/// those of the run.
HttpResponse get_result(const Reads& reads, std::int64_t id);

/// GET runs/{id}/arm: the calibrated arm as a file of schema touchcal/arm/5; as for the
/// result.
HttpResponse get_arm(const Reads& reads, std::int64_t id);

inline constexpr std::string_view kHtml = "text/html; charset=utf-8";
inline constexpr std::string_view kCsv = "text/csv; charset=utf-8";

struct ReportForm {
  std::string format = "html";
  std::string language = "en";  // of the page; the other formats have none
};

/// GET runs/{id}/report: touchcal/report/1, of a proof or a check touchcal/verification-report/1, as a page
/// for people ("html"), a table of touches ("csv") or itself ("json"); 400 for another format or language.
HttpResponse get_report(const Reads& reads, const StoredRun& run, const ReportForm& form);

/// POST runs/{id}/report/monte-carlo: the same of a run that is over, with `count` simulated calibrations
/// beside the linear uncertainty of its result, which is identified again for them. 409 where that gives
/// another result than the stored one, and for a proof or a check. Takes about a millisecond for each.
HttpResponse get_simulated_report(const Reads& reads, const StoredRun& run, const ReportForm& form,
                                  int count);

}  // namespace cell
