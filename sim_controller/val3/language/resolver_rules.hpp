#pragma once

#include <string_view>

/// Rules of names and types: the ids that the resolver's findings name. What each means and why a controller
/// refuses it is in checks/rules.
namespace val3::resolver_rules {

inline constexpr std::string_view kUndefinedName = "undefined-name";
inline constexpr std::string_view kUndefinedProgram = "undefined-program";
inline constexpr std::string_view kUndefinedInstruction = "undefined-instruction";
inline constexpr std::string_view kUndefinedField = "undefined-field";
inline constexpr std::string_view kUndefinedLibrary = "undefined-library";
inline constexpr std::string_view kUnknownSignal = "unknown-signal";
inline constexpr std::string_view kUnknownAddon = "unknown-addon";  // a note
inline constexpr std::string_view kNotPublic = "not-public";
inline constexpr std::string_view kProgramWithoutCall = "program-without-call";
inline constexpr std::string_view kWrongType = "wrong-type";
inline constexpr std::string_view kOperatorType = "operator-type";
inline constexpr std::string_view kConditionType = "condition-type";
inline constexpr std::string_view kDioCondition = "dio-condition";
inline constexpr std::string_view kMissingArgument = "missing-argument";
inline constexpr std::string_view kExtraArgument = "extra-argument";
inline constexpr std::string_view kNotAVariable = "not-a-variable";
inline constexpr std::string_view kConstantByReference = "constant-by-reference";  // a note
inline constexpr std::string_view kIndexNotAllowed = "index-not-allowed";
inline constexpr std::string_view kIndexCount = "index-count";
inline constexpr std::string_view kIndexType = "index-type";
inline constexpr std::string_view kElementIndex = "element-index";
inline constexpr std::string_view kArrayDimensions = "array-dimensions";
inline constexpr std::string_view kBraces = "braces";  // too many fields, or no type to be of
inline constexpr std::string_view kCaseType = "case-type";
inline constexpr std::string_view kLocalToTask = "local-to-task";
inline constexpr std::string_view kTaskName = "task-name";
inline constexpr std::string_view kTaskPriority = "task-priority";

}  // namespace val3::resolver_rules
