#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "service/documents/conditions_document.hpp"
#include "service/documents/run_report.hpp"
#include "service/report/internal/html.hpp"

/// Parts of the HTML reports; each returns markup or the text of a cell.
namespace cell {

// report_page.cpp
/// A number in fmt's `format`; "unknown" if absent.
std::string figure_text(std::optional<double> value, const char* format);

/// The same, but empty if absent.
std::string figure_if_known(std::optional<double> value, const char* format);

/// A string; "unknown" if it is empty or absent.
std::string text_or_unknown(const std::string& text);
std::string text_or_unknown(const std::optional<std::string>& text);

/// A section with its title.
std::string section(std::string_view title, const std::string& inner);
std::string pairs_table(std::string_view caption, const std::vector<html::Row>& rows);
/// A list of texts; empty without any.
std::string bullets(const std::vector<std::string>& texts);

/// The whole document, with the title at the head of each printed page: letters, digits and hyphens only.
std::string printed_page(std::string_view title, const std::string& body);

// report_front.cpp
/// Day of the run's end, its id, the first digits of the digest of its raw data: "20260131-7-3f2a9c1b". The
/// same for every report of the run.
std::string report_number(const ReportHead& head);
std::string report_number(std::string day, const std::string& run, const std::string& raw_data_sha256);
std::string verdict_box(std::string_view verdict, std::string_view words,
                        const std::vector<std::string>& reasons);
std::vector<html::Row> identification_rows(const ReportHead& head, const std::string& issued_at,
                                           const std::string& arm, const ConditionsDocument& conditions);
/// Places for two: "Calibrated by", and who approves it.
std::string signatures(std::string_view maker);
std::string front_sheet(std::string_view title, const std::string& inner);
std::string front_page(const RunReport& report, const std::string& issued_at);

// report_run.cpp
std::string run_section(std::string_view caption, const ReportHead& head,
                        const ConditionsDocument& conditions);
std::string made_again_table(const ReportHead& head);
std::string incident_tables(const ReportHead& head);  // refused contacts, faults

// report_budget.cpp
std::string budget_section(const ResultDocument& result);

// report_certificates.cpp
std::string certificates_table(const ConditionsDocument& conditions);
std::string certificates_section(const ConditionsDocument& conditions);

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
