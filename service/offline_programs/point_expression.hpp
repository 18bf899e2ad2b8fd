#pragma once

#include <optional>
#include <string>

#include "service/offline_programs/carried_points.hpp"

namespace cell {

/// The value of an expression of a program, where it can be told from the stored data alone: constants,
/// stored trsfs and points with a constant index, and `appro` of these.
class PointExpressions {
 public:
  PointExpressions(const FilteredData& data, double mm_per_unit) : data_(data), mm_per_unit_(mm_per_unit) {}

  struct KnownTrsf {
    SixNumbers trsf{};      // degrees, lengths in the application's unit
    std::string stored_as;  // the variable whose stored value it is; empty for a constant
    [[nodiscard]] double distance_mm(double mm_per_unit) const;
    [[nodiscard]] bool turns() const;
  };
  [[nodiscard]] std::optional<KnownTrsf> trsf(const ScannedProgram& program,
                                              const std::vector<ProgramToken>& tokens,
                                              TokenRange range) const;
  /// `is_filtered` also of a point that was moved on from a filtered one.
  [[nodiscard]] std::optional<StoredPlace> place(const ScannedProgram& program,
                                                 const std::vector<ProgramToken>& tokens,
                                                 TokenRange range) const;
  [[nodiscard]] double mm_per_unit() const { return mm_per_unit_; }

 private:
  /// "pPick[3]" of a global variable with a constant index; empty for anything else.
  static std::string element_named_in(const ScannedProgram& program, const std::vector<ProgramToken>& tokens,
                                      TokenRange range);

  const FilteredData& data_;
  double mm_per_unit_;
};

}  // namespace cell
