#include "sim_controller/val3/checks/check_rules.hpp"
#include "sim_controller/val3/checks/rule_tables.hpp"

namespace val3::rule_tables {
namespace {

using enum Severity;
using namespace check_rules;

constexpr Rule kRulesOfChecks[] = {
    {kSyncBlocking, kWarning, "A synchronous task may be made to wait.",
     "It stands still until then, and with it all that it watches over (M6 page 81).",
     "Do it in an asynchronous task."},
    {kSyncWait, kNote, "A synchronous task lets periods pass.",
     "What it waits for is tested once a period (M6 page 81).", "Only delay(0) ends a period's work."},
    {kSyncPeriod, kWarning, "A period is no multiple of the controller's.",
     "It is rounded down to a multiple of 4 ms (M6 page 88).", "Write the period that is meant."},
    {kSyncPeriods, kWarning, "Synchronous tasks have more than two periods.",
     "A third one at the same time is run-time error 32 (M6 pages 81 and 179).", "Use two periods."},
    {kBusyLoop, kWarning, "A loop goes round without waiting.",
     "It takes a task's whole turn each time, in a synchronous task 3,000 lines of every period (M6 pages 80 "
     "and 81).",
     "Put delay(0) into it, or wait for its end by wait() or watch()."},
    {kUnreachable, kWarning, "A line is never reached.",
     "A return or an endless loop stands before it, or a condition that is never true.",
     "Take it away, or what stands before it."},
    {kLocalNeverSet, kWarning, "A local is read before it is set.",
     "It has the default of its type; a point has no frame: run-time error 162 (M6 page 126).",
     "Set it first."},
    {kGlobalNeverSet, kNote, "A variable is read and never set.",
     "It is stored without a value, and has the default of its type.",
     "Store its value, or set it in start()."},
    {kNeverLinked, kWarning, "An input, output or channel is used and linked to nothing.",
     "Run-time error 123 (M6 page 179).", "Link it in the data, or by dioLink and its kind."},
    {kUnusedVariable, kNote, "A variable is never used.", "It takes memory, and a reader looks for its use.",
     "Take it away."},
    {kUnusedParameter, kNote, "A parameter is never used.", "All that call the program give it for nothing.",
     "Take it away."},
    {kUnusedProgram, kNote, "Nothing calls a program.", "It is private, and no task begins with it.",
     "Take it away, or make it public."},
    {kSocketNeverClosed, kWarning, "A socket is used and never closed.",
     "A connection that its peer has left stays, and the next one is not taken, until clearBuffer closes it "
     "(M6 "
     "page 62).",
     "Call clearBuffer when a read fails, and in stop()."},
    {kConstantIndex, kWarning, "An index or a dimension is outside of the array.",
     "Run-time error 20 above it, 21 below 0 (M6 pages 21 and 179).", "Correct the index or the size."},
    {kDivisionByZero, kWarning, "A number is divided by 0.", "Run-time error 10 (M6 page 179).",
     "Correct the divisor."},
    {kWriteToInput, kWarning, "An input is written.", "Run-time error 122 (M6 page 179).",
     "Link the variable to an output, or leave the line out."},
    {kFixedFrame, kWarning, "The frame world or the tool flange is changed.",
     "They are fixed: run-time error 161 or 160 at the next geometric calculation (M6 pages 122 and 179).",
     "Use a frame or tool of the application."},
    {kEndlessRecursion, kWarning, "A program calls itself without a condition.",
     "Each call takes run memory until there is none: run-time error 41 (M6 page 18).",
     "Write a loop, or a condition around the call."},
    {kRunMemory, kWarning, "Run memory is too small.",
     "Parameters and locals of the calls of a task stand in it (M6 page 18). start() and stop() that do not "
     "fit are refused by --run. The bytes are estimated, and low.",
     "Give the project a larger stackSize, or the program smaller locals."},
    {kBlend, kNote, "A straight move blends in an application that waits for a contact.",
     "A missing blend is joint in s7 data: the arm does not stop at the point.", "Set the blend to off."},
    {kJointComparison, kNote, "The opposite of a comparison of joints.",
     "a>b is true when every axis is above: !(a>b) is when some is not (M6 page 109).",
     "Compare the axes that matter."},
    {kExactComparison, kNote, "A computed number is compared to the last digit.",
     "cos(90) is not 0 (M6 page 34).", "Compare the difference with a small number."},
    {kTimeoutZero, kNote, "A channel waits without end.", "A time-out of 0 is none (M6 page 64).",
     "Give it a time."},
    {kNewerInstruction, kError, "A version has not this instruction.",
     "A controller of that version does not compile the program. What came between s6.4 and s7 no source "
     "says: there it is a warning.",
     "Use one that it has."},
    {kNewerForm, kError, "A version has not this form.",
     "A controller of that version does not compile the program.", "Write it in another way."},
    {kNewerName, kError, "A name is too long for a version.",
     "Until s7 a name has at most 15 characters (M6 page 20).", "Shorten it."},
    {kOlderInstruction, kNote, "An instruction of s5 that the manual of s6 has no more.",
     "A later controller may not have it.", "Use what replaced it."},
};

}  // namespace

std::span<const Rule> of_checks() { return kRulesOfChecks; }

}  // namespace val3::rule_tables
