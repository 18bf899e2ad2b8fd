#pragma once

#include <optional>
#include <string>

#include "service/documents/run_report.hpp"

/// Parts of the HTML report. Each takes the report or its result document and returns markup.
namespace cell {

/// A number in fmt's `format`; "unknown" if absent.
std::string figure_text(std::optional<double> value, const char* format);

/// The same, but empty if absent.
std::string figure_if_known(std::optional<double> value, const char* format);

/// A string; "unknown" if it is empty or absent.
std::string text_or_unknown(const std::string& text);
std::string text_or_unknown(const std::optional<std::string>& text);

// report_tables.cpp
std::string errors_table(const ResultDocument& result);       // Table III
std::string intervals_table(const ResultDocument& result);    // each candidate with its uncertainty
std::string repetition_tables(const ResultDocument& result);  // Tables IV and V
std::string distance_tables(const ResultDocument& result);    // Tables VI and VII
/// What was estimated beside the 37 errors; empty without any.
std::string model_table(const ResultDocument& result);
std::string block_and_probe_table(const ResultDocument& result);

// report_figures.cpp
std::string condition_figure(const ResultDocument& result);  // Figure 4
std::string distance_figures(const RunReport& report);       // Figures 5 to 12

}  // namespace cell
