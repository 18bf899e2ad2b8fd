#include "sim_controller/val3/checks/rule_tables.hpp"
#include "sim_controller/val3/files/file_rules.hpp"

namespace val3::rule_tables {
namespace {

using enum Severity;
using namespace file_rules;

constexpr std::string_view kNothingLoads = "A controller loads nothing of an application with it.";
constexpr std::string_view kOurLimit =
    "This reader's own limit: a file from outside must not fill the memory.";

constexpr Rule kRulesOfFiles[] = {
    {kFileMissing, kError, "A file that the project lists is not there.", kNothingLoads,
     "Put the file there, or take it out of the project."},
    {kFileUnreadable, kError, "A file cannot be read.", kNothingLoads, "Give the right to read it."},
    {kFileTooLarge, kError, "A file, or all of them together, is larger than is read.", kOurLimit,
     "Check a smaller folder, or divide the data."},
    {kFileOutside, kError, "A path leads out of the folder of applications.",
     "Nothing outside of the folder that was named is opened.", "Check the folder that holds both."},
    {kNoProject, kError, "There is no project here.", "An application is a folder with its project file.",
     "Name the folder of a .pjx file."},
    {kBrokenXml, kError, "The file is not XML.", kNothingLoads,
     "Save it once more on the tool that wrote it."},
    {kEncoding, kError, "The characters are not those that the file declares.",
     "s5 files are ISO-8859-1, later ones UTF-8.", "Save the file in the encoding of its first line."},
    {kUnknownForm, kError, "The file has a form of no version that is known.",
     "The name space in the first element says which reader is needed.",
     "Take the file of a project of s5 to s8."},
    {kTooManyFiles, kError, "The project has more files than are read.", kOurLimit, "Divide the project."},
    {kUnlistedProgram, kNote, "A program lies in the folder, and the project does not list it.",
     "A controller does not load it.", "List it, or take it away."},
    {kFileName, kNote, "A file is named otherwise than what it holds.",
     "Names of programs are taken from inside of the file.", "Rename the file."},
    {kUnknownElement, kError, "An element is none of this kind of file.",
     "A controller calls a file with a field that it does not know corrupted.",
     "Correct the element's name."},
    {kUnknownAttribute, kError, "An attribute is none of this element.",
     "A controller calls a file with a field that it does not know corrupted.",
     "Correct the attribute's name."},
    {kMissingAttribute, kError, "An attribute is missing that has no default.", kNothingLoads, "Write it."},
    {kBadVersion, kError, "The version cannot be read.", "It decides which language the application is of.",
     "Write it as s7.7.2."},
    {kBadValue, kError, "A value is not of its type.", kNothingLoads, "Correct the value."},
    {kBadSize, kError, "A size is no number of elements.",
     "Arrays have one to three dimensions, each of at least one element.", "Write size=\"n\" or \"n m\"."},
    {kBadIndex, kError, "An index is outside of its array.", kNothingLoads, "Correct the index or the size."},
    {kDuplicateIndex, kError, "An element has two values.", "A controller refuses an array item given twice.",
     "Take one of them away."},
    {kUnknownType, kError, "There is no type of this name.", kNothingLoads,
     "Correct it, or list the type in the project."},
    {kMissingFather, kError, "A point, frame or tool is given in what is not there.",
     "A father that is missing, of another type or beyond its size is refused at load.",
     "Declare the frame or tool, or name another."},
    {kCircularFather, kError, "Frames or tools are given in each other.", "None of them has a place then.",
     "Give one of them in world or flange."},
    {kNestedTooDeep, kError, "Structures are nested deeper than is read.", kOurLimit, "Make them flatter."},
    {kInvalidName, kError, "A name has characters that names do not have.",
     "A name is a letter, then letters, digits and _ (M6 page 20).", "Rename it."},
    {kNameTooLong, kError, "A name is too long.", "Until s7 a name has at most 15 characters (M6 page 20).",
     "Shorten it."},
    {kReservedName, kError, "A word of the language is taken for a name.", kNothingLoads, "Rename it."},
    {kDuplicateName, kError, "A name is given twice.", kNothingLoads, "Rename one of them."},
    {kArrayByValue, kError, "An array is passed by value.",
     "Arrays are passed by reference only; a controller refuses the program (M6 page 22).",
     "Write use=\"reference\"."},
    {kNoStart, kError, "There is no program start().", "An application begins with it (M6 page 18).",
     "Add it; a library needs none."},
    {kNoStop, kError, "There is no program stop().", "An application ends with it (M6 page 18).",
     "Add it, if empty; a library needs none."},
    {kStartParameters, kError, "start() or stop() has parameters.", "A controller calls them without.",
     "Take the parameters away."},
    {kNoCode, kError, "A program has no code.", kNothingLoads, "Give it begin and end."},
    {kLibraryMissing, kWarning, "A library is not beside the project.",
     "What is used of it is not checked here. A controller reads every library that is declared (M6 page "
     "95).",
     "Check the folder that holds the application and its libraries."},
    {kLibraryEncrypted, kWarning, "A library is encrypted.", "What is used of it is not checked.",
     "Check with the library as it was before."},
    {kCircularLibrary, kError, "Libraries use each other in a circle.",
     "Circular use is not supported (M6 page 95).", "Move what both use to a third."},
    {kLibrariesTooDeep, kError, "Libraries are nested deeper than is read.", kOurLimit, "Make them flatter."},
    {kTypeMissing, kError, "The project of a type is not there.", kNothingLoads,
     "Put the type's project beside this one."},
    {kCircularType, kError, "A type contains itself.", kNothingLoads, "Take the field away."},
};

}  // namespace

std::span<const Rule> of_files() { return kRulesOfFiles; }

}  // namespace val3::rule_tables
