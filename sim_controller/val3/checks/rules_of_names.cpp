#include "sim_controller/val3/checks/rule_tables.hpp"
#include "sim_controller/val3/language/resolver_rules.hpp"

namespace val3::rule_tables {
namespace {

using enum Severity;
using namespace resolver_rules;

constexpr std::string_view kNotCompiled = "A controller does not compile the program.";

constexpr Rule kRulesOfNames[] = {
    {kUndefinedName, kError, "Nothing has this name.", kNotCompiled, "Declare it, or correct the name."},
    {kUndefinedProgram, kError, "There is no program of this name.", kNotCompiled,
     "List it in the project, or correct the name."},
    {kUndefinedInstruction, kError, "There is no instruction of this name.",
     "It is in neither manual (M5, M6), and in no program of s7 that is known.", "Correct the name."},
    {kUndefinedField, kError, "A type has no such field.", kNotCompiled, "Correct the field's name."},
    {kUndefinedLibrary, kError, "There is no library of this alias.", kNotCompiled,
     "Declare it in the project."},
    {kUnknownSignal, kNote, "The controller's own library io has no signal of this name.",
     "Only a board, a fieldbus or a socket of the cell can give it (M6 page 57); what it is is not checked.",
     "Put the cell's project io beside the application, or correct the name."},
    {kUnknownAddon, kNote, "An instruction of an add-on that is not known here.",
     "It is there on a controller with the add-on only, and its arguments are not checked.",
     "Make sure that every controller has the add-on."},
    {kNotPublic, kError, "The name is private in its library.",
     "A library's interface is its public data and programs (M6 page 93).", "Make it public there."},
    {kProgramWithoutCall, kError, "A program stands where an instruction must.",
     "Programs have no result, and are called by call (M6 page 23).", "Write call before it."},
    {kWrongType, kError, "A value is of another type than is wanted.", kNotCompiled,
     "Convert it, or correct what it is given to."},
    {kOperatorType, kError, "The operator is not defined for these types.",
     "M6 page 33 and the page of each type.", "Convert one side."},
    {kConditionType, kError, "A condition is no bool.", kNotCompiled, "Compare it with something."},
    {kDioCondition, kError, "An input or output stands as a condition by itself.",
     "A dio is compared with a bool or a dio, or assigned; it is no bool. Only ! takes it as one.",
     "Write d==true."},
    {kMissingArgument, kError, "An argument is missing.", kNotCompiled, "Give it."},
    {kExtraArgument, kError, "There is an argument too many.", kNotCompiled, "Take it away."},
    {kNotAVariable, kError, "A value stands where a variable must.",
     "What is written to must be able to keep it.", "Put it into a variable first."},
    {kConstantByReference, kNote, "A value is given to a parameter by reference.",
     "What the program writes to it is lost (M6 page 22).", "Give it a variable, or pass by value."},
    {kIndexNotAllowed, kError, "What has no elements has an index.", kNotCompiled, "Take the index away."},
    {kIndexCount, kError, "An array has another number of dimensions.", kNotCompiled,
     "Write one index for each dimension."},
    {kIndexType, kError, "An index is of the wrong type.",
     "The index of an array is a num, the key of a collection a string.", "Convert it."},
    {kElementIndex, kWarning, "A parameter that is one element has an index.",
     "Any index but 0 is outside of it: run-time error 20.", "Declare the parameter as an array."},
    {kArrayDimensions, kError, "An array has another number of dimensions than the parameter.", kNotCompiled,
     "Declare both with the same number."},
    {kBraces, kError, "Values in braces do not fit.",
     "They have the fields of their type in order, at most all of them (M6 page 20).",
     "Write the type's fields, structures in braces of their own."},
    {kCaseType, kError, "A case is of another type than its switch.", kNotCompiled, "Convert it."},
    {kLocalToTask, kError, "A new task gets a reference to a local.",
     "References of a task are to globals: the local may be gone (M6 pages 87 and 88).", "Give it a global."},
    {kTaskName, kWarning, "The name is none of a task.", "Run-time error 29 (M6 page 87).",
     "Rename the task."},
    {kTaskPriority, kWarning, "A task's priority is outside of 1 to 100.",
     "The line fails when it runs (M6 page 87).", "Choose one from 1 to 100."},
};

}  // namespace

std::span<const Rule> of_names() { return kRulesOfNames; }

}  // namespace val3::rule_tables
