#pragma once

#include <string_view>

/// Rules of what a controller takes and a programmer would not want.
namespace val3::check_rules {

inline constexpr std::string_view kSyncBlocking = "sync-blocking";
inline constexpr std::string_view kSyncWait = "sync-wait";  // a note
inline constexpr std::string_view kSyncPeriod = "sync-period";
inline constexpr std::string_view kSyncPeriods = "sync-periods";
inline constexpr std::string_view kBusyLoop = "busy-loop";
inline constexpr std::string_view kUnreachable = "unreachable";
inline constexpr std::string_view kLocalNeverSet = "local-never-set";
inline constexpr std::string_view kGlobalNeverSet = "global-never-set";
inline constexpr std::string_view kNeverLinked = "never-linked";
inline constexpr std::string_view kUnusedVariable = "unused-variable";  // notes
inline constexpr std::string_view kUnusedParameter = "unused-parameter";
inline constexpr std::string_view kUnusedProgram = "unused-program";
inline constexpr std::string_view kSocketNeverClosed = "socket-never-closed";
inline constexpr std::string_view kConstantIndex = "constant-index";
inline constexpr std::string_view kDivisionByZero = "division-by-zero";
inline constexpr std::string_view kWriteToInput = "write-to-input";
inline constexpr std::string_view kFixedFrame = "fixed-frame";
inline constexpr std::string_view kEndlessRecursion = "endless-recursion";
inline constexpr std::string_view kRunMemory = "run-memory";
inline constexpr std::string_view kBlend = "blend";                       // a note
inline constexpr std::string_view kJointComparison = "joint-comparison";  // a note
inline constexpr std::string_view kExactComparison = "exact-comparison";  // a note
inline constexpr std::string_view kTimeoutZero = "timeout-zero";          // a note
inline constexpr std::string_view kNewerInstruction = "newer-instruction";
inline constexpr std::string_view kNewerForm = "newer-form";
inline constexpr std::string_view kOlderInstruction = "older-instruction";  // a note
inline constexpr std::string_view kNewerName = "newer-name";

}  // namespace val3::check_rules
