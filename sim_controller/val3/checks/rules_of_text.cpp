#include "sim_controller/val3/checks/rule_tables.hpp"
#include "sim_controller/val3/language/syntax_rules.hpp"

namespace val3::rule_tables {
namespace {

using enum Severity;
using namespace syntax_rules;

constexpr std::string_view kProgramRefused = "A controller does not compile the program.";

constexpr Rule kRulesOfText[] = {
    {kMissingBegin, kError, "The code does not begin with begin.", kProgramRefused, "Write begin."},
    {kMissingEnd, kError, "The code does not end with end.", kProgramRefused, "Write end."},
    {kCodeBehindEnd, kError, "There is code behind end.", kProgramRefused, "Move it before end."},
    {kUnpairedBlock, kError, "A block's word has no partner.", kProgramRefused, "Add the missing word."},
    {kBreakOutsideCase, kError, "break stands outside of a case.",
     "break ends a case, and leaves no loop (M6 page 27).", "Leave a loop by its condition."},
    {kCaseWithoutBreak, kError, "A case does not end with break.", "Every case does (M6 page 27).",
     "Write break."},
    {kCaseAfterDefault, kError, "A case stands behind default, or default twice.",
     "default is the last (M6 page 27).", "Move default to the end."},
    {kLineOutsideCase, kError, "A line of a switch is in none of its cases.", kProgramRefused,
     "Move it into a case."},
    {kSyntax, kError, "The line cannot be read.", kProgramRefused, "Correct it."},
    {kMissingBracket, kError, "A bracket is missing, or closes nothing.", kProgramRefused,
     "Pair the brackets."},
    {kMissingQuote, kError, "A text does not end.", kProgramRefused,
     "Close it; a quote inside of a text is chr(34)."},
    {kTrailingCharacters, kError, "Something stands behind the end of an instruction.",
     "A line is one instruction.", "Write it on a line of its own."},
    {kTrailingComment, kError, "A comment stands behind an instruction.",
     "// begins a comment as the first characters of a line only (M6 page 23).",
     "Write it on a line of its own."},
    {kAssignmentInExpression, kError, "= stands inside an expression.", "= is a statement (M6 page 33).",
     "To compare, write ==."},
    {kAssignmentTarget, kError, "What is assigned to is no variable.", kProgramRefused, "Name a variable."},
    {kTwoUnaryOperators, kError, "Two signs follow each other.", kProgramRefused,
     "Put the inner one between parentheses."},
    {kNoEffect, kError, "The line does nothing.", kProgramRefused, "Take it away, or assign its value."},
    {kExpressionTooDeep, kError, "An expression is nested too deep.", "A controller has such a limit too.",
     "Divide it over several lines."},
    {kNumberTooLarge, kError, "A number is too large.", "A num is of double precision (M6 page 34).",
     "Write a smaller one."},
    {kStringTooLong, kError, "A text is longer than 128 bytes.", "A string has 128 bytes (M6 page 48).",
     "Put it together of two."},
    {kLineTooLong, kError, "A line is too long.", "A controller has such a limit too.", "Divide it."},
    {kKeywordCase, kError, "A keyword is written in another case.",
     "All programs in use write them as the manuals do.", "Write it as in the manual."},
    {kDisabledLine, kNote, "A line that begins with ; is not run.", "A pendant may disable a line so.",
     "Take it away if it is not wanted."},
    {kTooManyFindings, kError, "A file has more findings than are told.", "The rest of it is not told.",
     "Mend the first ones."},
};

}  // namespace

std::span<const Rule> of_text() { return kRulesOfText; }

}  // namespace val3::rule_tables
