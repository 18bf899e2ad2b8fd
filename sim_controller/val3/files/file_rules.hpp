#pragma once

#include <string_view>

/// Rules of an application's files: the ids that the readers' findings name. What each means and why a
/// controller refuses it is in checks/rules.
namespace val3::file_rules {

// A file as such.
inline constexpr std::string_view kFileMissing = "file-missing";
inline constexpr std::string_view kFileUnreadable = "file-unreadable";
inline constexpr std::string_view kFileTooLarge = "file-too-large";  // or all files together
inline constexpr std::string_view kFileOutside = "file-outside";     // a path that leaves the neighbourhood
inline constexpr std::string_view kNoProject = "no-project";
inline constexpr std::string_view kBrokenXml = "broken-xml";
inline constexpr std::string_view kEncoding = "encoding";
inline constexpr std::string_view kUnknownForm = "unknown-form";  // of no version that is known
inline constexpr std::string_view kTooManyFiles = "too-many-files";
inline constexpr std::string_view kUnlistedProgram = "unlisted-program";  // a note
inline constexpr std::string_view kFileName = "file-name";                // a note

// What a file says.
inline constexpr std::string_view kUnknownElement = "unknown-element";
inline constexpr std::string_view kUnknownAttribute = "unknown-attribute";
inline constexpr std::string_view kMissingAttribute = "missing-attribute";
inline constexpr std::string_view kBadVersion = "bad-version";
inline constexpr std::string_view kBadValue = "bad-value";
inline constexpr std::string_view kBadSize = "bad-size";
inline constexpr std::string_view kBadIndex = "bad-index";
inline constexpr std::string_view kDuplicateIndex = "duplicate-index";
inline constexpr std::string_view kUnknownType = "unknown-type";
inline constexpr std::string_view kMissingFather = "missing-father";
inline constexpr std::string_view kCircularFather = "circular-father";
inline constexpr std::string_view kNestedTooDeep = "nested-too-deep";

// Declarations.
inline constexpr std::string_view kInvalidName = "invalid-name";
inline constexpr std::string_view kNameTooLong = "name-too-long";
inline constexpr std::string_view kReservedName = "reserved-name";
inline constexpr std::string_view kDuplicateName = "duplicate-name";
inline constexpr std::string_view kArrayByValue = "array-by-value";
inline constexpr std::string_view kNoStart = "no-start";
inline constexpr std::string_view kNoStop = "no-stop";
inline constexpr std::string_view kStartParameters = "start-parameters";  // or stop's
inline constexpr std::string_view kNoCode = "no-code";

// Other projects.
inline constexpr std::string_view kLibraryMissing = "library-missing";
inline constexpr std::string_view kLibraryEncrypted = "library-encrypted";
inline constexpr std::string_view kCircularLibrary = "circular-library";
inline constexpr std::string_view kLibrariesTooDeep = "libraries-too-deep";
inline constexpr std::string_view kTypeMissing = "type-missing";
inline constexpr std::string_view kCircularType = "circular-type";

}  // namespace val3::file_rules
