#include "service/cli/comparison_text.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <cmath>

#include "service/cli/figure_text.hpp"

namespace cell {
namespace {

/// Of each part: the most striking ones say it all.
constexpr std::size_t kCombinationsShown = 5;

std::string shares_text(const ComparisonDocument::Combination& combination) {
  constexpr std::size_t kWidth = 66;
  std::string shares;
  for (const ComparisonDocument::Share& share : combination.shares) {
    const std::string one = fmt::format(" {}{}", figure_or_dash(share.share, "{:+.1f} "), share.parameter);
    if (shares.size() + one.size() > kWidth) return shares + " ...";
    shares += one;
  }
  return shares;
}

std::string part_text(const char* name, const ComparisonDocument::Part& part,
                      const std::optional<double>& p_min) {
  if (!part.changed) return fmt::format("\n{}: nothing of it was identified by both\n", name);
  std::string lines = fmt::format("\n{}: {} (chance {}, at least {}; chi-square {} of {})\n", name,
                                  *part.changed ? "CHANGED" : "as it was", figure_or_dash(part.p, "{:.3g}"),
                                  figure_or_dash(p_min, "{:.2g}"), figure_or_dash(part.chi_square, "{:.1f}"),
                                  figure_or_dash(part.degrees_of_freedom, "{:.0f}"));
  lines += "     E_n  combination\n";
  const std::size_t shown = std::min(part.combinations.size(), kCombinationsShown);
  for (std::size_t k = 0; k < shown; ++k) {
    const auto& one = part.combinations[k];
    lines += fmt::format("{} {:>6} {}\n", one.e_n && std::abs(*one.e_n) > 1.0 ? '!' : ' ',
                         figure_or_dash(one.e_n, "{:.2f}"), shares_text(one));
  }
  if (shown < part.combinations.size())
    lines += fmt::format("  and {} that differ less\n", part.combinations.size() - shown);
  return lines;
}

}  // namespace

std::string comparison_text(const ComparisonDocument& document) {
  std::string lines = fmt::format(
      "runs {} and {}: {}\n", document.earlier, document.later,
      document.verdict.accepted.value_or(false) ? "UNCHANGED, but for the arm's growth" : "CHANGED");
  for (const std::string& reason : document.verdict.reasons) lines += "  " + reason + "\n";
  lines += fmt::format("\ngrowth of the arm              {} ppm (std {})\n",
                       figure_or_dash(document.growth_ppm, "{:.1f}"),
                       figure_or_dash(document.std_growth_ppm, "{:.1f}"));
  lines += fmt::format("tip in the workspace box, rms  {} mm apart; chance alone makes {}\n",
                       figure_or_dash(document.tip_difference_mm, "{:.3f}"),
                       figure_or_dash(document.std_tip_difference_mm, "{:.3f}"));
  lines += part_text("arm", document.arm, document.p_min);
  lines += part_text("stylus", document.tool, document.p_min);
  return lines + "\nE_n beyond 1 (!): noise does not explain it; chance makes one of 20 so.\n";
}

}  // namespace cell
