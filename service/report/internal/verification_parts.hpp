#pragma once

#include <map>
#include <optional>
#include <string>
#include <string_view>

#include "service/documents/verification_document.hpp"
#include "service/documents/verification_report.hpp"

/// Parts of the report of a proof or a check.
namespace cell {

/// The stored result of a proof or a check; neither document where there is none that can be read.
struct FoundVerification {
  std::optional<ProofDocument> proof;
  std::optional<CheckDocument> check;
  std::string unreadable;  // why not, of a result that is there; else empty
};

// verification_report.cpp
FoundVerification read_verification(std::string_view result);
/// Of each touch by its number: the distance of a proof, the change of a check.
std::map<int, std::optional<double>> deviations_of(const FoundVerification& found);

// verification_tables.cpp
std::string proof_tables(const ProofDocument& proof);
std::string check_tables(const CheckDocument& check);
/// A figure a plane, all of one scale.
std::string deviation_figures(const VerificationReport& report, bool is_proof);
/// Each quantity from check to check, with the limits where there are some.
std::string check_charts(const ChecksDocument& checks);
std::string verifying_touches_table(const VerificationReport& report, bool is_proof);

}  // namespace cell
