#pragma once

#include <string_view>

/// Rules of a program's text: the ids that the parser's findings name. What each means and why a controller
/// refuses it is in checks/rules.
namespace val3::syntax_rules {

inline constexpr std::string_view kMissingBegin = "missing-begin";
inline constexpr std::string_view kMissingEnd = "missing-end";
inline constexpr std::string_view kCodeBehindEnd = "code-behind-end";
inline constexpr std::string_view kUnpairedBlock = "unpaired-block";
inline constexpr std::string_view kBreakOutsideCase = "break-outside-case";
inline constexpr std::string_view kCaseWithoutBreak = "case-without-break";
inline constexpr std::string_view kCaseAfterDefault = "case-after-default";  // or a second default
inline constexpr std::string_view kLineOutsideCase =
    "line-outside-case";  // in a switch, in none of its cases
inline constexpr std::string_view kSyntax = "syntax";
inline constexpr std::string_view kMissingBracket = "missing-bracket";
inline constexpr std::string_view kMissingQuote = "missing-quote";
inline constexpr std::string_view kTrailingCharacters = "trailing-characters";
inline constexpr std::string_view kTrailingComment = "trailing-comment";
inline constexpr std::string_view kAssignmentInExpression = "assignment-in-expression";
inline constexpr std::string_view kAssignmentTarget = "assignment-target";  // left of = stands no variable
inline constexpr std::string_view kTwoUnaryOperators = "two-unary-operators";
inline constexpr std::string_view kNoEffect = "no-effect";
inline constexpr std::string_view kExpressionTooDeep = "expression-too-deep";
inline constexpr std::string_view kNumberTooLarge = "number-too-large";
inline constexpr std::string_view kStringTooLong = "string-too-long";
inline constexpr std::string_view kLineTooLong = "line-too-long";
inline constexpr std::string_view kKeywordCase = "keyword-case";
inline constexpr std::string_view kDisabledLine = "disabled-line";  // a note
inline constexpr std::string_view kTooManyFindings =
    "too-many-findings";  // the rest of a program is not told

}  // namespace val3::syntax_rules
