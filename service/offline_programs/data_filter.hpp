#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "service/offline_programs/filter_list.hpp"
#include "service/offline_programs/offline_target.hpp"
#include "service/offline_programs/stored_data.hpp"

/// Points and joints of a VAL3 data file for the arm as it really is.
namespace cell {

/// One value of a variable that the list marks offline.
struct FilteredValue {
  std::string variable;
  std::string key;   // as StoredElement has it
  std::string name;  // "pPick[3]"
  int line = 0;      // of the data file
  CorrectionStatus status = CorrectionStatus::kRefused;
  std::string reason;  // of a warning, or why it was refused and stays as it was
  double moved_mm = 0.0;
  /// Attributes of that line that had been left out because they were 0, each behind the one before it.
  std::vector<std::string> inserted;
};

/// Where a stored point is, before the filter.
struct StoredPlace {
  Eigen::Isometry3d world_from_tool = Eigen::Isometry3d::Identity();  // metres
  bool is_filtered = false;
};

struct FilteredData {
  std::string text;
  std::vector<FilteredValue> values;
  /// For the person who filters: what was left as it was, frames that have to be touched first.
  std::vector<std::string> notes;
  FilteredMark mark;

  /// For program_warnings(): variables of points and joints that are filtered, with the largest moved_mm;
  /// those of points; stored points and trsfs by names as "pPick[3]".
  std::map<std::string, double, std::less<>> filtered_variables;
  std::map<std::string, StoredKind, std::less<>> kinds;
  std::map<std::string, StoredPlace, std::less<>> points;
  std::map<std::string, SixNumbers, std::less<>> trsfs;

  [[nodiscard]] std::size_t count(CorrectionStatus status) const;
};

/// Asks the corrector for each stored value of the variables that the list marks offline, in the order of the
/// file, and writes what it answers: of a joint the six angles, of a point its place in its own frame.
/// Only these numbers change in the text; an attribute that was left out because it was 0 is inserted when it
/// is no longer. A number whose six decimals stay the same keeps its writing. What the corrector refuses
/// stays as it was. `mm_per_unit`: 1, or 25.4 of an application in inches.
///
/// Throws ConfigError with the line and what to do: what read_stored_data(), FrameChains and
/// refuse_filtered_file() throw; a variable that holds points or joints, or is of a type that is not known,
/// and is not in the list; a name of the list that is not in the file; `offline` for anything but points and
/// joints of six axes; an offline point without a frame, or in one of a library.
FilteredData filter_data(const std::string& source, std::string bytes, const FilterList& list,
                         const Corrector& corrector, double mm_per_unit = 1.0);

}  // namespace cell
