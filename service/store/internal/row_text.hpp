#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "service/store/run_store.hpp"

/// How rows name their columns and their states, for those who write and those who read them.
namespace cell::row {

inline const std::string kJointColumns =
    "j1_microdeg, j2_microdeg, j3_microdeg, j4_microdeg, j5_microdeg, j6_microdeg";

/// Of touches and superseded_touches, after run_id; those up to the schema before kTouchNoiseSchema, those up
/// to the one before kTouchContactsSchema, and all.
inline const std::string kTouchColumnsWithoutNoise =
    "number, plane, role, " + kJointColumns +
    ", source, overtravel_dmm, captured_at, session, sequence, "
    "aimed_with";
inline const std::string kTouchColumnsWithoutContacts = kTouchColumnsWithoutNoise + ", noise_um";
inline const std::string kFirstJointColumns =
    "first_j1_microdeg, first_j2_microdeg, first_j3_microdeg, first_j4_microdeg, first_j5_microdeg, "
    "first_j6_microdeg";
inline const std::string kAgainJointColumns =
    "again_j1_microdeg, again_j2_microdeg, again_j3_microdeg, again_j4_microdeg, again_j5_microdeg, "
    "again_j6_microdeg";
inline const std::string kTouchColumns =
    kTouchColumnsWithoutContacts + ", first_source, " + kFirstJointColumns + ", " + kAgainJointColumns;
inline constexpr int kTouchColumnCount = 29;

/// "table touches, run 3, number 12".
std::string place_of(std::string_view table, std::int64_t run_id, std::optional<int> number = {});
/// Of a row of runs: it was not imported.
inline const std::string kOfThisDaemon = "runs.id NOT IN (SELECT run_id FROM imported_runs)";
inline const std::string kOtherChecksum = "the row is not as it was written (its checksum differs)";

std::string_view plan_change_name(PlanChange::Kind kind);  // "put_off"

/// Each throws std::runtime_error for a text that no version has written.
PlanChange::Kind plan_change_named(const std::string& name);
RunOutcome outcome_named(const std::string& name);
Verdict verdict_named(const std::string& name);
RunKind kind_named(const std::string& name);

}  // namespace cell::row
