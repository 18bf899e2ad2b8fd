#include "service/cli/verification_text.hpp"

#include <spdlog/fmt/fmt.h>

#include "service/cli/figure_text.hpp"
#include "service/cli/result_text.hpp"

namespace cell {
namespace {

std::string verdict_line(const char* what, const VerificationVerdict& verdict, const char* good,
                         const char* bad) {
  std::string lines = fmt::format("{}: {}\n", what,
                                  !verdict.accepted   ? "no verdict"
                                  : *verdict.accepted ? good
                                                      : bad);
  for (const std::string& reason : verdict.reasons) lines += fmt::format("  {}\n", reason);
  return lines;
}

}  // namespace

std::string proof_text(const ProofDocument& proof) {
  std::string lines =
      verdict_line("proof", proof.verdict, "PROVED: the calibrated arm is right where it was not calibrated",
                   "NOT PROVED");
  lines += fmt::format("\nof run {}, {} touches{}\n", proof.of_run, proof.touch_count,
                       proof.complete ? "" : ", not complete");
  if (!proof.rms_mm) return lines;
  lines += fmt::format("distance from the block, rms   {} mm, at most {} mm\n",
                       figure_or_dash(proof.rms_mm, "{:.4f}"), figure_or_dash(proof.rms_max_mm, "{:.3f}"));
  lines += fmt::format(
      "chance of so large a scatter   {}, at least {} (chi-square {} of {} degrees of freedom)\n",
      figure_or_dash(proof.p, "{:.3g}"), figure_or_dash(proof.p_min, "{:.2g}"),
      figure_or_dash(proof.chi_square, "{:.1f}"), figure_or_dash(proof.degrees_of_freedom, "{:.0f}"));
  lines += fmt::format("noise of a touch               {} um\n", figure_or_dash(proof.noise_um, "{:.1f}"));
  if (const auto& moved = proof.moved_mm)
    lines += fmt::format("the block moved by             {:.1f} {:.1f} {:.1f} mm\n", (*moved)[0], (*moved)[1],
                         (*moved)[2]);
  for (const ProofDocument::Power& power : proof.power)
    lines += fmt::format("would have seen {:<15}in {} % of cases where it moves the tip by 0.1 mm\n",
                         power.alternative, power.power ? fmt::format("{:.0f}", 100.0 * *power.power) : "-");
  return lines;
}

std::string check_text(const CheckDocument& check) {
  std::string lines = verdict_line("check", check.verdict, "UNCHANGED since the reference", "CHANGED");
  lines += fmt::format("\nof run {}, {} touches{}, reference of {} of {} checks\n", check.of_run,
                       check.touch_count, check.complete ? "" : ", not complete", check.reference.count,
                       check.reference.needed);
  if (!check.rms_mm) return lines;
  lines += fmt::format("change, rms                    {} mm (noise of a touch {} um)\n",
                       figure_or_dash(check.rms_mm, "{:.4f}"), figure_or_dash(check.noise_um, "{:.1f}"));
  lines += fmt::format("chance of so large a change    {}, of any joint's {}, each at least {}\n",
                       figure_or_dash(check.p, "{:.3g}"), figure_or_dash(check.joint_p, "{:.3g}"),
                       figure_or_dash(check.p_min, "{:.2g}"));
  lines +=
      fmt::format("growth of the arm              {} ppm (std {}){}\n",
                  figure_or_dash(check.growth_ppm, "{:.1f}"), figure_or_dash(check.std_growth_ppm, "{:.1f}"),
                  check.warmer_k ? fmt::format(", as of {:+.1f} K", *check.warmer_k) : "");
  lines += "\nif it alone had changed      mrad       std\n";
  for (const CheckDocument::Joint& joint : check.joints)
    lines += fmt::format("joint {}                  {:>9} {:>9}\n", joint.joint,
                         figure_or_dash(joint.offset_mrad, "{:.3f}"),
                         figure_or_dash(joint.std_offset_mrad, "{:.3f}"));
  return lines;
}

namespace {

std::string across_line(const char* what, const QualificationDocument::Across& across) {
  if (!across.size_mm) return {};
  return fmt::format("{}   {} mm (std {}), towards {} deg in R_7\n", what,
                     figure_or_dash(across.size_mm, "{:.4f}"), figure_or_dash(across.std_mm, "{:.4f}"),
                     figure_or_dash(across.direction_deg, "{:.0f}"));
}

std::string criterion_line(const QualificationDocument::Criterion& criterion) {
  const bool is_test = criterion.unit == "p";
  const char* format = is_test ? "{:.3g}" : "{:.4f}";
  return fmt::format("{:<16}{:>12}{:>16}{:>10}  {}\n", criterion.name,
                     figure_or_dash(criterion.value, format) + (is_test ? "" : " mm"),
                     !criterion.limit ? "no limit"
                     : is_test        ? fmt::format("at least {:.3g}", *criterion.limit)
                                      : figure_or_dash(criterion.limit, format) + " mm",
                     figure_or_dash(criterion.expanded, "{:.4f}"), criterion.passed ? "pass" : "FAIL");
}

}  // namespace

std::string qualification_text(const QualificationDocument& qualification) {
  std::string lines = verdict_line("probe", qualification.verdict, "QUALIFIED", "NOT QUALIFIED");
  lines += fmt::format("\nprobe {}, {} touches{}\n", qualification.probe, qualification.touch_count,
                       qualification.complete ? "" : ", not complete");
  lines += qualification.of_run
               ? fmt::format("held against the calibration of run {}\n", *qualification.of_run)
               : fmt::format(
                     "held against no calibration, so that neither a change of the stylus nor a known "
                     "length is judged: {}\n",
                     qualification.no_of_run.value_or("nobody says why"));
  const auto& scatter = qualification.scatter;
  if (!scatter.std_um) return lines;
  lines += fmt::format("scatter of a touch      {} um, in 95 of 100 {} to {} ({} degrees of freedom)\n",
                       figure_or_dash(scatter.std_um, "{:.1f}"), figure_or_dash(scatter.low_um, "{:.1f}"),
                       figure_or_dash(scatter.high_um, "{:.1f}"),
                       figure_or_dash(scatter.degrees_of_freedom, "{:.0f}"));
  lines += across_line("run-out of the ball  ", qualification.run_out);
  lines += across_line("lobes of the trigger ", qualification.lobes);
  lines += across_line("since calibrated     ", qualification.change);
  for (const QualificationDocument::Length& length : qualification.lengths)
    lines += fmt::format("planes {} and {}          {} mm, measured {} mm wrong (std {}, p {})\n",
                         length.planes[0], length.planes[1], figure_or_dash(length.known_mm, "{:.3f}"),
                         figure_or_dash(length.error_mm, "{:+.4f}"), figure_or_dash(length.std_mm, "{:.4f}"),
                         figure_or_dash(length.p, "{:.3g}"));
  lines += fmt::format("\n{:<16}{:>12}{:>16}{:>10}  decision\n", "limits", "value", "limit", "+- U");
  for (const QualificationDocument::Criterion& criterion : qualification.criteria)
    lines += criterion_line(criterion);
  return lines;
}

std::string tool_text(const ToolDocument& tool) {
  std::string lines = verdict_line("tool", tool.verdict, "FOUND", "NOT FOUND within its limits");
  lines += fmt::format("\ntool {} on the calibrated arm of run {}, {} touches{}\n", tool.tool, tool.of_run,
                       tool.touch_count, tool.complete ? "" : ", not complete");
  if (!tool.position_mm) return lines;
  const auto& at = *tool.position_mm;
  const auto std_mm = tool.std_position_mm.value_or(std::array<double, 3>{});
  lines += fmt::format("its tip in R_6           {:.3f} {:.3f} {:.3f} mm (std {:.3f} {:.3f} {:.3f})\n", at[0],
                       at[1], at[2], std_mm[0], std_mm[1], std_mm[2]);
  lines += fmt::format("by the cell's file       {:.3f} {:.3f} {:.3f} mm, off by {} mm\n", tool.drawn_mm[0],
                       tool.drawn_mm[1], tool.drawn_mm[2], figure_or_dash(tool.off_drawing_mm, "{:.3f}"));
  lines += fmt::format(
      "predicted over the box   {} mm rms{}\n", figure_or_dash(tool.box_rms_mm, "{:.4f}"),
      tool.box_rms_max_mm ? fmt::format(", at most {:.3f} mm", *tool.box_rms_max_mm) : ", no limit");
  lines += fmt::format("distance from the planes {} mm rms (chance of so large a one {}, at least {})\n",
                       figure_or_dash(tool.rms_mm, "{:.4f}"), figure_or_dash(tool.p, "{:.3g}"),
                       figure_or_dash(tool.p_min, "{:.2g}"));
  return lines;
}

std::string text_of_result(std::string_view document) {
  const std::string schema = schema_of(document);
  if (schema == ProofDocument().schema) return proof_text(read_proof(document));
  if (schema == CheckDocument().schema) return check_text(read_check(document));
  if (schema == QualificationDocument().schema) return qualification_text(read_qualification(document));
  if (schema == ToolDocument().schema) return tool_text(read_tool(document));
  return result_text(read_result(document));
}

}  // namespace cell
