#pragma once

#include <optional>
#include <string>
#include <vector>

#include "service/offline_programs/data_filter.hpp"

/// What the programs of an application make of its filtered points. They are not changed: this lists where a
/// program makes another point of a filtered one, or goes between two of them on a straight line, with the
/// error that is to be expected (service/offline_programs/predicted_error.hpp).
namespace cell {

struct ProgramFile {
  std::string name;
  std::string bytes;
};

enum class ProgramWarningKind { kAppro, kCompose, kTrsf, kHere, kSetFrame, kStraightLine, kArc };

struct ProgramWarning {
  ProgramWarningKind kind = ProgramWarningKind::kAppro;
  std::string file;
  int line = 0;
  std::string code;                // the line, cut after kShownCodeMax bytes
  std::string point;               // the filtered variable
  std::optional<double> error_um;  // where a figure can be given
  std::string error;               // in words, with the figure
  std::string remedy;
};
inline constexpr std::size_t kShownCodeMax = 160;

struct ProgramWarnings {
  std::vector<ProgramWarning> warnings;  // by file in the order given, then by line
  std::vector<std::string> unread;       // files that could not be read, each with the reason
  bool is_cut = false;                   // there are more than kProgramWarningsMax
};
inline constexpr std::size_t kProgramWarningsMax = 10'000;

/// `mm_per_unit` as for filter_data(), which made `data`. A file that cannot be read is told and left out.
///
/// What this cannot see: a point that is made in a library or by an add-on; a position that a program
/// computes from numbers; where a straight line begins whose start is set elsewhere, which is listed without
/// a figure.
ProgramWarnings program_warnings(const std::vector<ProgramFile>& files, const FilteredData& data,
                                 double mm_per_unit = 1.0);

/// "appro", "compose", ".trsf", "here", "setFrame", "straight line", "movec".
std::string_view word_of(ProgramWarningKind kind);

}  // namespace cell
