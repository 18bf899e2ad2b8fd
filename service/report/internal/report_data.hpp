#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "cs8_protocol/messages.hpp"
#include "service/documents/report_head.hpp"
#include "service/report/report_document.hpp"

/// Parts of the JSON reports.
namespace cell {

/// An integer of 10^-6 degrees as degrees, without rounding.
std::string degrees_text(std::int64_t microdegrees);
std::vector<std::string> degrees_texts(const cs8::JointsMicrodeg& joints);

ReportHead head_of(const RunRecord& record);

}  // namespace cell
