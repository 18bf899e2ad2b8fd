#include "service/offline_programs/straight_lines.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>

#include "calib_core/geometry/units.hpp"
#include "service/offline_programs/predicted_error.hpp"

namespace cell {
namespace {

/// After these the arm may have come from elsewhere, or be sent elsewhere meanwhile.
bool breaks_path(std::string_view word) {
  for (const std::string_view known :
       {"if",        "else", "elseIf", "endIf",      "while",          "endWhile",   "do",
        "until",     "for",  "endFor", "switch",     "case",           "default",    "break",
        "endSwitch", "call", "return", "taskCreate", "taskCreateSync", "resetMotion"})
    if (word == known) return true;
  return false;
}

double mm_of(double um) { return um * 1e-3; }

/// Whether one line in twenty is further off than it may be.
bool bows_too_far(double length_mm) {
  return mm_of(line_deviation(length_mm).one_in_twenty_um) > kLineDeviationMaxMm;
}

double distance_mm(const StoredPlace& a, const StoredPlace& b) {
  return calib::mm_from_metres((a.world_from_tool.translation() - b.world_from_tool.translation()).norm());
}

class PathReader {
 public:
  PathReader(const ScannedProgram& program, const CarriedPoints& carried, const PointExpressions& expressions,
             std::vector<ProgramWarning>& warnings)
      : program_(program), carried_(carried), expressions_(expressions), warnings_(warnings) {}

  void line(std::size_t number) {
    const auto& tokens = program_.lines[number];
    if (tokens.empty()) return;
    if (breaks_path(tokens[0].text)) is_start_known_ = false;
    for (std::size_t i = 0; i < tokens.size(); ++i)
      if (is_own_name(tokens, i) && is_sign(tokens, i + 1, "(")) move(number, tokens, i);
  }

 private:
  void move(std::size_t number, const std::vector<ProgramToken>& tokens, std::size_t at) {
    const std::string_view word = tokens[at].text;
    const std::size_t points = word == "movec" ? 2 : word == "movel" || word == "movej" ? 1 : 0;
    if (points == 0) return;
    const std::vector<TokenRange> arguments = listed_in(tokens, at + 1);
    if (arguments.size() < points) {
      is_start_known_ = false;
      return;
    }
    bool touches = false, is_known = true;
    double length_mm = 0.0;
    const std::string* origin = nullptr;
    for (std::size_t i = 0; i < points; ++i) {
      if (const std::string* const found = carried_.origin_in(program_, tokens, arguments[i])) {
        touches = true;
        origin = found;
      }
      const auto end = expressions_.place(program_, tokens, arguments[i]);
      is_known &= end && is_start_known_;
      if (end && is_start_known_) {
        touches &= end->is_filtered && start_.is_filtered;
        length_mm = std::max(length_mm, distance_mm(*end, start_));
      }
      is_start_known_ = end.has_value();
      start_ = end.value_or(StoredPlace{});
    }
    if (word == "movec" && origin != nullptr)
      tell_arc(number, *origin, is_known ? std::optional(length_mm) : std::nullopt);
    if (word == "movel" && touches && (!is_known || bows_too_far(length_mm)))
      tell(number, *origin, is_known ? std::optional(length_mm) : std::nullopt);
  }

  /// Each arc is told, short ones too: what becomes of it nobody sees in the points.
  void tell_arc(std::size_t number, const std::string& origin, std::optional<double> chord_mm) {
    ProgramWarning warning = warning_at(program_, number, ProgramWarningKind::kArc);
    warning.point = origin;
    warning.error =
        "of its points those that are filtered are corrected, the arc itself is not: the controller runs the "
        "circle through them";
    if (!chord_mm) {
      warning.error += "; how far apart they are is not known here";
    } else {
      const LineDeviation deviation = line_deviation(*chord_mm);
      warning.error_um = deviation.median_um;
      warning.error += fmt::format(
          "; two of them are {:.0f} mm apart, between which it is {:.3f} mm off ({:.3f} mm of one arc in "
          "twenty)",
          *chord_mm, mm_of(deviation.median_um), mm_of(deviation.one_in_twenty_um));
    }
    warning.remedy = chord_mm && !bows_too_far(*chord_mm)
                         ? std::string("none at this length")
                         : fmt::format("divide it into arcs with filtered points at most {:.0f} mm apart",
                                       kStraightLineMaxMm);
    warnings_.push_back(std::move(warning));
  }

  void tell(std::size_t number, const std::string& origin, std::optional<double> length_mm) {
    ProgramWarning warning = warning_at(program_, number, ProgramWarningKind::kStraightLine);
    warning.point = origin;
    if (length_mm) {
      const LineDeviation deviation = line_deviation(*length_mm);
      warning.error_um = deviation.median_um;
      warning.error = fmt::format(
          "{:.0f} mm long: its middle is {:.3f} mm off the line ({:.3f} mm of one line in twenty)",
          *length_mm, mm_of(deviation.median_um), mm_of(deviation.one_in_twenty_um));
      const int points = points_between(*length_mm);
      warning.remedy = fmt::format("store and filter {} {} between its ends, one every {:.0f} mm at least",
                                   points, points == 1 ? "point" : "points", kStraightLineMaxMm);
    } else {
      const LineDeviation deviation = line_deviation(2 * kStraightLineMaxMm);
      warning.error = fmt::format(
          "its length is not known here: where it is longer than {:.0f} mm its middle is off the line, "
          "{:.3f} mm at {:.0f} mm, as the square of the length",
          kStraightLineMaxMm, mm_of(deviation.median_um), 2 * kStraightLineMaxMm);
      warning.remedy = fmt::format("store and filter a point every {:.0f} mm", kStraightLineMaxMm);
    }
    warnings_.push_back(std::move(warning));
  }

  const ScannedProgram& program_;
  const CarriedPoints& carried_;
  const PointExpressions& expressions_;
  std::vector<ProgramWarning>& warnings_;
  bool is_start_known_ = false;
  StoredPlace start_;  // where the arm is
};

}  // namespace

void append_straight_lines(const ScannedProgram& program, const CarriedPoints& carried,
                           const PointExpressions& expressions, std::vector<ProgramWarning>& warnings) {
  PathReader path(program, carried, expressions, warnings);
  for (std::size_t i = 0; i < program.lines.size(); ++i) path.line(i);
}

ProgramWarning warning_at(const ScannedProgram& program, std::size_t line, ProgramWarningKind kind) {
  constexpr std::string_view kBlanksAround = " \t\r\f\v";
  ProgramWarning warning{.kind = kind, .file = program.text.file, .line = program.text.lines[line].number};
  const std::string& text = program.text.lines[line].text;
  const std::size_t begin = std::min(text.find_first_not_of(kBlanksAround), text.size());
  warning.code =
      text.substr(begin, std::min(text.find_last_not_of(kBlanksAround) + 1 - begin, kShownCodeMax));
  // A file of s5 is in ISO-8859-1, and a cut may be inside a character: documents are in UTF-8.
  std::ranges::replace_if(
      warning.code, [](char c) { return c < ' ' || c > '~'; }, '?');
  return warning;
}

}  // namespace cell
