#pragma once

#include <cstddef>
#include <map>
#include <string>
#include <string_view>
#include <vector>

/// Which variables of a VAL3 data file are filtered. A line a variable:
///
///   # comment
///   pPick   offline gripper
///   pTaught taught
///   jHome   leave
///   # filtered SHA-256-OF-THE-ORIGINAL SHA-256-OF-THE-RESULT
///   # filtered-points pPick SHA-256-OF-WHAT-THEY-WERE-MADE
namespace cell {

inline constexpr std::size_t kFilterListBytesMax = 1U << 20U;
/// Of a tool; a variable's name has at most 36 in s8.
inline constexpr std::size_t kListedNameMax = 64;

enum class FilterMark {
  kOffline,  // written by numbers off the arm: filtered
  kTaught,   // shown to the arm, whose errors it holds already: never changed
  kLeave,    // never changed
};

struct ListedVariable {
  FilterMark mark = FilterMark::kLeave;
  std::string tool;  // empty where none is named
  int line = 0;
};

/// What a filter made of a variable, by points_digest().
struct FilteredPoints {
  std::string variable;
  std::string sha256;
  std::string source = {};  // where it is recorded, of what was read
};

struct FilteredMark {
  std::string original_sha256;
  std::string result_sha256;
  std::vector<FilteredPoints> points = {};  // of the variables that were changed
  std::string source = {};                  // where it is recorded, of what was read
};

struct FilterList {
  std::string source;  // as errors call it
  std::map<std::string, ListedVariable, std::less<>> variables;
  std::vector<FilteredMark> filtered;
  std::vector<FilteredPoints> points;  // of all filters
};

/// Bytes in UTF-8 with or without a byte order mark, lines ended in either way. Throws ConfigError with the
/// line: a name that VAL3 does not allow, another mark, further words, a variable that is there twice, a mark
/// of a filtered file that is none; and when it is larger than kFilterListBytesMax.
FilterList parse_filter_list(std::string source, std::string_view text);

/// Throws ConfigError if the bytes are what a filter made: their points hold the correction already.
void refuse_filtered_file(const FilterList& list, const std::string& data_source,
                          const std::string& sha256_of_data);

/// The list's text with the mark behind its last line, in the list's own line ends; what of it stands there
/// already is not repeated. As it is where nothing was changed.
std::string with_filtered_mark(std::string_view list_text, const FilteredMark& mark);

}  // namespace cell
