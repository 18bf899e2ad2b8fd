#pragma once

#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "service/documents/qualification_document.hpp"
#include "service/documents/tool_document.hpp"
#include "service/documents/verification_document.hpp"
#include "service/documents/verification_report.hpp"
#include "service/report/internal/html.hpp"

/// Parts of the report of a proof, a check, a qualification or a touched tool.
namespace cell {

/// The stored result; no document where there is none that can be read.
struct FoundVerification {
  std::optional<ProofDocument> proof;
  std::optional<CheckDocument> check;
  std::optional<QualificationDocument> qualification;
  std::optional<ToolDocument> tool;
  std::string unreadable;  // why not, of a result that is there; else empty
};

// verification_report.cpp
FoundVerification read_verification(std::string_view result);
/// Of each touch by its number: the distance of a proof or a tool, the change of a check, the deviation of a
/// qualification.
std::map<int, std::optional<double>> deviations_of(const FoundVerification& found);

// qualification_tables.cpp
std::string qualification_tables(const Words& words, const QualificationDocument& qualification);

// tool_tables.cpp
std::string tool_tables(const Words& words, const ToolDocument& tool);

/// What the deviation of a touch is in a report, in English.
struct DeviationWords {
  const char* axis;    // of the curves
  const char* level;   // what 0 is
  const char* column;  // of the table
};

// verification_tables.cpp
std::string proof_tables(const Words& words, const ProofDocument& proof);
std::string check_tables(const Words& words, const CheckDocument& check);
/// How many touches, and whether these are all.
std::string touches_text(const Words& words, int count, bool complete);
/// A row of a figure that has no limit, and the limits as a table.
html::Row told(const std::string& what, const std::string& value);
std::string figures_table(const Words& words, const std::vector<html::Row>& rows);
/// A figure a plane, all of one scale.
std::string deviation_figures(const Words& words, const VerificationReport& report,
                              const DeviationWords& deviation);
/// Each quantity from check to check, with the limits where there are some.
std::string check_charts(const Words& words, const ChecksDocument& checks);
std::string verifying_touches_table(const Words& words, const VerificationReport& report,
                                    const DeviationWords& deviation);

}  // namespace cell
