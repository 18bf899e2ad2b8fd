#include "service/offline_programs/program_warnings.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>

#include "calib_core/geometry/units.hpp"
#include "config/config_error.hpp"
#include "service/offline_programs/predicted_error.hpp"
#include "service/offline_programs/straight_lines.hpp"

namespace cell {
namespace {

constexpr std::string_view kStoreItRemedy =
    "store the point that is meant, and filter it; or correct it at run time";

/// Calls and fields of one program.
class UseReader {
 public:
  UseReader(const ScannedProgram& program, const CarriedPoints& carried, const PointExpressions& expressions,
            const FilteredData& data, std::vector<ProgramWarning>& warnings)
      : program_(program), carried_(carried), expressions_(expressions), data_(data), warnings_(warnings) {}

  void line(std::size_t number) {
    const auto& tokens = program_.lines[number];
    for (std::size_t i = 0; i < tokens.size(); ++i) {
      if (!is_own_name(tokens, i)) continue;
      const std::string_view word = tokens[i].text;
      if (is_sign(tokens, i + 1, "(")) {
        if (word == "appro") moved_on(number, tokens, i, ProgramWarningKind::kAppro, 2);
        if (word == "compose") moved_on(number, tokens, i, ProgramWarningKind::kCompose, 3);
        if (word == "setFrame") set_frame(number, tokens, i);
        if (word == "here") here(number, tokens);
      } else {
        field(number, tokens, i);
      }
    }
  }

 private:
  void tell(std::size_t number, ProgramWarningKind kind, const std::string& point,
            std::optional<double> error_um, std::string error, std::string_view remedy) {
    ProgramWarning warning = warning_at(program_, number, kind);
    warning.point = point;
    warning.error_um = error_um;
    warning.error = std::move(error);
    warning.remedy = remedy;
    warnings_.push_back(std::move(warning));
  }

  static std::string as_far_as_it_goes() {
    return fmt::format("as far as it goes: {} um a mm", kCarriedErrorUmPerMm);
  }

  /// appro(point, trsf) and compose(point, frame, trsf).
  void moved_on(std::size_t number, const std::vector<ProgramToken>& tokens, std::size_t at,
                ProgramWarningKind kind, std::size_t count) {
    const std::vector<TokenRange> arguments = listed_in(tokens, at + 1);
    if (arguments.empty()) return;
    const std::string* const origin = carried_.origin_in(program_, tokens, arguments[0]);
    if (origin == nullptr) return;
    const auto by =
        arguments.size() == count ? expressions_.trsf(program_, tokens, arguments.back()) : std::nullopt;
    // A turn in a frame swings the point about the frame's origin: how far depends on where it is.
    if (!by || (kind == ProgramWarningKind::kCompose && by->turns()))
      return tell(number, kind, *origin, std::nullopt, as_far_as_it_goes(), kStoreItRemedy);
    const double distance_mm = by->distance_mm(expressions_.mm_per_unit());
    const double error_um = carried_error_um(distance_mm);
    tell(number, kind, *origin, error_um,
         fmt::format("{:.0f} um, at {:.4g} mm from the filtered point{}{}", error_um, distance_mm,
                     by->stored_as.empty() ? "" : ", as " + by->stored_as + " is stored",
                     by->turns() ? "; of its turn there is no figure" : ""),
         kStoreItRemedy);
  }

  void set_frame(std::size_t number, const std::vector<ProgramToken>& tokens, std::size_t at) {
    const std::vector<TokenRange> arguments = listed_in(tokens, at + 1);
    const std::string* first = nullptr;
    double moved_max_mm = 0.0;
    for (std::size_t i = 0; i < std::min<std::size_t>(arguments.size(), 3); ++i) {
      const std::string* const origin = carried_.origin_in(program_, tokens, arguments[i]);
      if (origin == nullptr) continue;
      if (first == nullptr) first = origin;
      moved_max_mm = std::max(moved_max_mm, data_.filtered_variables.at(*origin));
    }
    if (first != nullptr)
      tell(number, ProgramWarningKind::kSetFrame, *first,
           calib::um_from_metres(calib::metres_from_mm(moved_max_mm)),
           fmt::format("the frame moves with the corrections of its points, by up to {:.3f} mm, and all that "
                       "is given in it",
                       moved_max_mm),
           "make it from points that are not filtered");
  }

  void here(std::size_t number, const std::vector<ProgramToken>& tokens) {
    const std::string* const origin = carried_.origin_in(program_, tokens, {0, tokens.size()});
    if (origin != nullptr)
      tell(
          number, ProgramWarningKind::kHere, *origin, std::nullopt,
          "what the arm tells of its place is nominal, as a filtered point is: none beside such a point, the "
          "whole correction beside one that is not filtered",
          "mark the point taught where it is set from here()");
  }

  /// p.trsf, p[i].trsf
  void field(std::size_t number, const std::vector<ProgramToken>& tokens, std::size_t at) {
    const std::string* const origin = carried_.origin_of(program_, tokens[at].text);
    if (origin == nullptr) return;
    const std::size_t behind = is_sign(tokens, at + 1, "[") ? closing_of(tokens, at + 1) + 1 : at + 1;
    if (is_sign(tokens, behind, ".") && behind + 1 < tokens.size() && tokens[behind + 1].text == "trsf")
      tell(number, ProgramWarningKind::kTrsf, *origin, std::nullopt, as_far_as_it_goes(), kStoreItRemedy);
  }

  const ScannedProgram& program_;
  const CarriedPoints& carried_;
  const PointExpressions& expressions_;
  const FilteredData& data_;
  std::vector<ProgramWarning>& warnings_;
};

ScannedProgram scanned(ProgramText text) {
  ScannedProgram program{.text = std::move(text)};
  program.lines.reserve(program.text.lines.size());
  for (const ProgramLine& line : program.text.lines) program.lines.push_back(program_tokens(line.text));
  return program;
}

}  // namespace

ProgramWarnings program_warnings(const std::vector<ProgramFile>& files, const FilteredData& data,
                                 double mm_per_unit) {
  ProgramWarnings result;
  std::vector<ScannedProgram> programs;
  for (const ProgramFile& file : files) {
    try {
      for (ProgramText& text : read_program_text(XmlText(file.name, file.bytes)))
        programs.push_back(scanned(std::move(text)));
    } catch (const ConfigError& error) {
      result.unread.emplace_back(error.what());
    }
  }
  const CarriedPoints carried(programs, data);
  const PointExpressions expressions(data, mm_per_unit);
  for (const ScannedProgram& program : programs) {
    std::vector<ProgramWarning> found;
    UseReader uses(program, carried, expressions, data, found);
    for (std::size_t i = 0; i < program.lines.size(); ++i) uses.line(i);
    append_straight_lines(program, carried, expressions, found);
    std::ranges::stable_sort(found, {}, &ProgramWarning::line);
    for (ProgramWarning& warning : found) {
      result.is_cut |= result.warnings.size() == kProgramWarningsMax;
      if (!result.is_cut) result.warnings.push_back(std::move(warning));
    }
  }
  return result;
}

std::string_view word_of(ProgramWarningKind kind) {
  switch (kind) {
    case ProgramWarningKind::kAppro:
      return "appro";
    case ProgramWarningKind::kCompose:
      return "compose";
    case ProgramWarningKind::kTrsf:
      return ".trsf";
    case ProgramWarningKind::kHere:
      return "here";
    case ProgramWarningKind::kSetFrame:
      return "setFrame";
    case ProgramWarningKind::kStraightLine:
      return "straight line";
    case ProgramWarningKind::kArc:
      return "movec";
  }
  return "";
}

}  // namespace cell
