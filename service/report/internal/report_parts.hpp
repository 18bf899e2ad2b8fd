#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "service/documents/conditions_document.hpp"
#include "service/documents/plane_places.hpp"
#include "service/documents/run_report.hpp"
#include "service/report/internal/html.hpp"

/// Parts of the HTML reports; each returns markup or the text of a cell.
namespace cell {

// report_page.cpp
/// A sentence that a run has stored in English: in the report's language where that has it (it then has no
/// figures), else marked as English.
html::Text stored_text(const Words& words, const std::string& text);
std::vector<html::Text> stored_texts(const Words& words, const std::vector<std::string>& texts);
/// Such a sentence behind an introduction in the report's language.
html::Text in_english(const Words& words, std::string_view introduction, const std::string& text);

/// A section with its title.
std::string section(std::string_view title, const std::string& inner);
std::string pairs_table(const Words& words, std::string_view caption, const std::vector<html::Row>& rows);
/// A list of texts; empty without any.
std::string bullets(const std::vector<html::Text>& texts);

/// The whole document, with the title at the head of each printed page: letters, digits and hyphens only.
std::string printed_page(const Words& words, std::string_view title, const std::string& body);

// report_front.cpp
/// Day of the run's end, its id, the first digits of the digest of its raw data: "20260131-7-3f2a9c1b". The
/// same for every report of the run.
std::string report_number(const ReportHead& head);
std::string report_number(std::string day, const std::string& run, const std::string& raw_data_sha256);
std::string verdict_box(const Words& words, std::string_view verdict, std::string_view meaning,
                        const std::vector<html::Text>& reasons);
std::vector<html::Row> identification_rows(const Words& words, const ReportHead& head,
                                           const std::string& issued_at, const std::string& arm,
                                           const ConditionsDocument& conditions);
/// Places for two: "Calibrated by", and who approves it.
std::string signatures(const Words& words, std::string_view maker);
std::string front_sheet(std::string_view title, const std::string& inner);
std::string front_page(const Words& words, const RunReport& report, const std::string& issued_at);

// report_run.cpp
std::string run_section(const Words& words, std::string_view caption, const ReportHead& head,
                        const ConditionsDocument& conditions);
std::string made_again_table(const Words& words, const ReportHead& head);
std::string incident_tables(const Words& words, const ReportHead& head);  // refused contacts, faults

// report_budget.cpp
std::string budget_section(const Words& words, const ResultDocument& result);

// report_certificates.cpp
std::string certificates_table(const Words& words, const ConditionsDocument& conditions);
std::string certificates_section(const Words& words, const ConditionsDocument& conditions);

// report_tables.cpp
/// plane_places_of() in the report's language.
PlanePlaces places_of(const Words& words, const ResultDocument& result);
std::string errors_table(const Words& words, const ResultDocument& result);  // Table III
std::string intervals_table(const Words& words,
                            const ResultDocument& result);  // each candidate with its uncertainty
std::string repetition_tables(const Words& words, const ResultDocument& result);  // Tables IV and V
std::string distance_tables(const Words& words, const ResultDocument& result);    // Tables VI and VII
/// What was estimated beside the 37 errors; empty without any.
std::string model_table(const Words& words, const ResultDocument& result);
std::string block_and_probe_table(const Words& words, const ResultDocument& result);

// report_figures.cpp
std::string condition_figure(const Words& words, const ResultDocument& result);  // Figure 4
std::string distance_figures(const Words& words, const RunReport& report);       // Figures 5 to 12

}  // namespace cell
