// The figures of a proof or a check beside their limits, and what each touch gave.
#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "service/report/internal/figure.hpp"
#include "service/report/internal/report_parts.hpp"
#include "service/report/internal/verification_parts.hpp"

namespace cell {

std::string or_dash(const std::optional<double>& value, const char* format) {
  return value ? figure_text(value, format) : "–";
}

html::Row told(const std::string& what, const std::string& value) { return {what, value, "", ""}; }

std::string figures_table(const std::vector<html::Row>& rows) {
  return html::table("Figures and their limits", {"figure", "value", "limit", "decision"}, rows);
}

namespace {

using html::Row;

constexpr double kMicrometresPerMillimetre = 1e3;

/// How far and along which axes: "300.0 (x +0.1, y -300.0, z +0.0)".
std::string way_text(const std::optional<std::array<double, 3>>& values, int decimals) {
  if (!values) return "–";
  const auto& [x, y, z] = *values;
  return fmt::format("{:.{}f} (x {:+.{}f}, y {:+.{}f}, z {:+.{}f})", std::hypot(x, y, z), decimals, x,
                     decimals, y, decimals, z, decimals);
}

/// Never "-0.0".
std::string warmth_text(const std::optional<double>& kelvin) {
  constexpr double kLastDigit = 0.1;
  if (kelvin && std::abs(*kelvin) < 0.5 * kLastDigit) return "0.0 K";
  return or_dash(kelvin, "{:+.1f} K");
}

/// "within" or "beyond"; a dash where one of the two is unknown.
std::string at_most(const std::optional<double>& figure, const std::optional<double>& limit) {
  if (!figure || !limit) return "–";
  return *figure > *limit ? "beyond" : "within";
}
std::string at_least(const std::optional<double>& figure, const std::optional<double>& limit) {
  if (!figure || !limit) return "–";
  return *figure < *limit ? "beyond" : "within";
}

Row chance_row(const std::string& what, const std::optional<double>& p, const std::optional<double>& p_min) {
  return {what, or_dash(p, "{:.3g}"), p_min ? figure_text(p_min, "at least {:g}") : "–", at_least(p, p_min)};
}

std::string chi_square_text(const std::optional<double>& chi_square, const std::optional<double>& degrees) {
  if (!chi_square) return "–";
  return or_dash(chi_square, "{:.1f}") + " of " + or_dash(degrees, "{:.0f}") + " degrees of freedom";
}

std::string touches_text(int count, bool complete) {
  return std::to_string(count) + (complete ? "" : ", not complete");
}

std::string growth_text(const CheckDocument& check) {
  if (!check.growth_ppm) return "–";
  return fmt::format("{:+.1f} ppm, known within {} (std)", *check.growth_ppm,
                     or_dash(check.std_growth_ppm, "{:.1f} ppm"));
}

}  // namespace

std::string proof_tables(const ProofDocument& proof) {
  std::vector<Row> power;
  for (const ProofDocument::Power& each : proof.power)
    power.push_back(
        {text_or_unknown(each.alternative), each.power ? fmt::format("{:.0f} %", 100.0 * *each.power) : "–"});
  const std::string seen =
      html::table("What these touches would have seen, each where it moves the tip by 0.1 mm",
                  {"what the model lacks", "seen in so many of such cases"}, power);
  return figures_table(
             {{"distance from the block, rms", or_dash(proof.rms_mm, "{:.4f} mm"),
               or_dash(proof.rms_max_mm, "at most {:g} mm"), at_most(proof.rms_mm, proof.rms_max_mm)},
              chance_row("chance of so large a scatter (p)", proof.p, proof.p_min),
              told("chi-square", chi_square_text(proof.chi_square, proof.degrees_of_freedom)),
              told("noise of a touch, as the calibration measured it", or_dash(proof.noise_um, "{:.1f} µm")),
              told("block moved since the calibration, mm", way_text(proof.moved_mm, 1)),
              told("block turned since the calibration, °", way_text(proof.turned_deg, 2)),
              told("touches", touches_text(proof.touch_count, proof.complete))}) +
         (power.empty() ? std::string() : seen);
}

std::string check_tables(const CheckDocument& check) {
  std::vector<Row> joints;
  for (const CheckDocument::Joint& joint : check.joints)
    joints.push_back({std::to_string(joint.joint), or_dash(joint.offset_mrad, "{:+.3f}"),
                      or_dash(joint.std_offset_mrad, "{:.3f}")});
  const std::string offsets =
      html::table("Change of a joint, as if it alone had changed beside the arm's growth",
                  {"joint", "change mrad", "std. uncertainty mrad"}, joints);
  return figures_table(
             {chance_row("chance of so large a change (p)", check.p, check.p_min),
              chance_row("chance of so large a change of any joint", check.joint_p, check.p_min),
              told("change of the distances, rms", or_dash(check.rms_mm, "{:.4f} mm")),
              told("chi-square", chi_square_text(check.chi_square, check.degrees_of_freedom)),
              told("noise of a touch, as the reference scatters", or_dash(check.noise_um, "{:.1f} µm")),
              told("growth of the arm's lengths since the reference", growth_text(check)),
              told("warmth that the growth stands for", warmth_text(check.warmer_k)),
              told("reference",
                   fmt::format("{} of {} checks", check.reference.count, check.reference.needed)),
              told("touches", touches_text(check.touch_count, check.complete))}) +
         (joints.empty() ? std::string() : offsets);
}

std::string deviation_figures(const VerificationReport& report, const DeviationWords& words) {
  std::map<int, Series> of_plane;
  double reach_um = 0.0;
  for (const VerificationReport::Touch& touch : report.touches) {
    if (!touch.deviation_mm) continue;
    const double micrometres = kMicrometresPerMillimetre * *touch.deviation_mm;
    of_plane[touch.plane].points.emplace_back(touch.touch, micrometres);
    reach_um = std::max(reach_um, std::abs(micrometres));
  }
  std::string drawn;
  for (auto& [plane, series] : of_plane) {
    series.name = "touch";
    drawn += svg({.title = fmt::format("Plane {}", plane),
                  .x_label = "number of the touch",
                  .y_label = words.axis,
                  .series = {series},
                  .level = 0.0,
                  .level_name = words.level,
                  .x_range = std::pair(1.0, static_cast<double>(report.touches.size())),
                  .y_range = std::pair(-reach_um, reach_um)});
  }
  return drawn.empty() ? html::paragraph("Without a verdict there is nothing to show.") : drawn;
}

std::string verifying_touches_table(const VerificationReport& report, const DeviationWords& words) {
  std::vector<Row> rows;
  for (const VerificationReport::Touch& touch : report.touches)
    rows.push_back(
        {std::to_string(touch.touch), std::to_string(touch.plane), or_dash(touch.deviation_mm, "{:+.4f}"),
         fmt::format("{}", fmt::join(touch.joints_deg, ", ")), text_or_unknown(touch.captured_at)});
  return html::table("Touches", {"touch", "plane", words.column, "joints °", "made"}, rows);
}

}  // namespace cell
