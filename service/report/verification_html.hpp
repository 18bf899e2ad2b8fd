#pragma once

#include <string>

#include "service/documents/verification_report.hpp"
#include "service/report/words/words.hpp"

namespace cell {

/// The report of a proof or a check as one HTML document without scripts and external resources.
std::string verification_html(const VerificationReport& report, const std::string& issued_at,
                              const Words& words = english());

}  // namespace cell
