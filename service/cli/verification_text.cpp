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

std::string text_of_result(std::string_view document) {
  const std::string schema = schema_of(document);
  if (schema == ProofDocument().schema) return proof_text(read_proof(document));
  if (schema == CheckDocument().schema) return check_text(read_check(document));
  return result_text(read_result(document));
}

}  // namespace cell
