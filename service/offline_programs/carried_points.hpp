#pragma once

#include <map>
#include <string>
#include <vector>

#include "service/offline_programs/data_filter.hpp"
#include "service/offline_programs/program_text.hpp"

namespace cell {

/// A program with the tokens of its lines, which look into the text.
struct ScannedProgram {
  ProgramText text;
  std::vector<std::vector<ProgramToken>> lines;
};

/// Which names hold a filtered point: the filtered variables themselves, and what an assignment or a call of
/// a program gives one to. By name and not by the order of the lines: what may hold one is taken to hold it.
class CarriedPoints {
 public:
  /// The programs of one application; they stay alive.
  CarriedPoints(const std::vector<ScannedProgram>& programs, const FilteredData& data);

  /// The filtered variable whose point the name may hold in that program; null for none.
  [[nodiscard]] const std::string* origin_of(const ScannedProgram& program, std::string_view name) const;
  /// The first of such variables that is named in the tokens [begin, end); null for none.
  [[nodiscard]] const std::string* origin_in(const ScannedProgram& program,
                                             const std::vector<ProgramToken>& tokens, TokenRange range) const;

 private:
  using Names = std::map<std::string, std::string, std::less<>>;  // to the variable that they came from

  bool follow(const ScannedProgram& program);
  bool follow_assignment(const ScannedProgram& program, const std::vector<ProgramToken>& tokens);
  bool follow_calls(const ScannedProgram& program, const std::vector<ProgramToken>& tokens);
  bool carries(Names& names, const std::string& name, const std::string& origin);

  const FilteredData& data_;
  std::map<std::string, const ScannedProgram*, std::less<>> programs_;
  Names global_;
  std::map<const ScannedProgram*, Names> own_;  // parameters and locals
};

/// By its type's word: "pointRx", "point", "pointVrb".
bool is_point_type(std::string_view type);

}  // namespace cell
