// The figures of a proof or a check beside their limits, and what each touch gave.
#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "service/report/internal/figure.hpp"
#include "service/report/internal/report_parts.hpp"
#include "service/report/internal/verification_parts.hpp"

namespace cell {

std::string touches_text(const Words& words, int count, bool complete) {
  return complete ? std::to_string(count) : words("{}, not complete", count);
}

html::Row told(const std::string& what, const std::string& value) { return {what, value, "", ""}; }

std::string figures_table(const Words& words, const std::vector<html::Row>& rows) {
  return html::table(words, words("Figures and their limits"),
                     {words("figure"), words("value"), words("limit"), words("decision")}, rows);
}

namespace {

using html::Row;

constexpr double kMicrometresPerMillimetre = 1e3;

/// How far and along which axes: "300.0 (x +0.1, y -300.0, z +0.0)".
std::string way_text(const Words& words, const std::optional<std::array<double, 3>>& values, int decimals) {
  if (!values) return "–";
  const auto& [x, y, z] = *values;
  return words("{:.{}f} (x {:+.{}f}, y {:+.{}f}, z {:+.{}f})", std::hypot(x, y, z), decimals, x, decimals, y,
               decimals, z, decimals);
}

/// Never "-0.0".
std::string warmth_text(const Words& words, const std::optional<double>& kelvin) {
  constexpr double kLastDigit = 0.1;
  if (kelvin && std::abs(*kelvin) < 0.5 * kLastDigit) return words("{:.1f} K", 0.0);
  return words.or_dash(kelvin, "{:+.1f} K");
}

/// "within" or "beyond"; a dash where one of the two is unknown.
std::string at_most(const Words& words, const std::optional<double>& figure,
                    const std::optional<double>& limit) {
  if (!figure || !limit) return "–";
  return *figure > *limit ? words("beyond") : words("within");
}
std::string at_least(const Words& words, const std::optional<double>& figure,
                     const std::optional<double>& limit) {
  if (!figure || !limit) return "–";
  return *figure < *limit ? words("beyond") : words("within");
}

Row chance_row(const Words& words, const char* what, const std::optional<double>& p,
               const std::optional<double>& p_min) {
  return {words(what), words.or_dash(p, "{:.3g}"), p_min ? words.figure(p_min, "at least {:g}") : "–",
          at_least(words, p, p_min)};
}

std::string chi_square_text(const Words& words, const std::optional<double>& chi_square,
                            const std::optional<double>& degrees) {
  if (!chi_square) return "–";
  return words("{:.1f} of {} degrees of freedom", *chi_square, words.or_dash(degrees, "{:.0f}"));
}

std::string growth_text(const Words& words, const CheckDocument& check) {
  if (!check.growth_ppm) return "–";
  return words("{:+.1f} ppm, known within {} (std)", *check.growth_ppm,
               words.or_dash(check.std_growth_ppm, "{:.1f} ppm"));
}

}  // namespace

std::string proof_tables(const Words& words, const ProofDocument& proof) {
  std::vector<Row> power;
  for (const ProofDocument::Power& each : proof.power)
    power.push_back(
        {words(words.known(each.alternative)), each.power ? words("{:.0f} %", 100.0 * *each.power) : "–"});
  const std::string seen =
      html::table(words, words("What these touches would have seen, each where it moves the tip by 0.1 mm"),
                  {words("what the model lacks"), words("seen in so many of such cases")}, power);
  return figures_table(
             words,
             {{words("distance from the block, rms"), words.or_dash(proof.rms_mm, "{:.4f} mm"),
               words.or_dash(proof.rms_max_mm, "at most {:g} mm"),
               at_most(words, proof.rms_mm, proof.rms_max_mm)},
              chance_row(words, "chance of so large a scatter (p)", proof.p, proof.p_min),
              told(words("chi-square"), chi_square_text(words, proof.chi_square, proof.degrees_of_freedom)),
              told(words("noise of a touch, as the calibration measured it"),
                   words.or_dash(proof.noise_um, "{:.1f} µm")),
              told(words("block moved since the calibration, mm"), way_text(words, proof.moved_mm, 1)),
              told(words("block turned since the calibration, °"), way_text(words, proof.turned_deg, 2)),
              told(words("touches"), touches_text(words, proof.touch_count, proof.complete))}) +
         (power.empty() ? std::string() : seen);
}

std::string check_tables(const Words& words, const CheckDocument& check) {
  std::vector<Row> joints;
  for (const CheckDocument::Joint& joint : check.joints)
    joints.push_back({std::to_string(joint.joint), words.or_dash(joint.offset_mrad, "{:+.3f}"),
                      words.or_dash(joint.std_offset_mrad, "{:.3f}")});
  const std::string offsets =
      html::table(words, words("Change of a joint, as if it alone had changed beside the arm's growth"),
                  {words("joint"), words("change mrad"), words("std. uncertainty mrad")}, joints);
  return figures_table(
             words,
             {chance_row(words, "chance of so large a change (p)", check.p, check.p_min),
              chance_row(words, "chance of so large a change of any joint", check.joint_p, check.p_min),
              told(words("change of the distances, rms"), words.or_dash(check.rms_mm, "{:.4f} mm")),
              told(words("chi-square"), chi_square_text(words, check.chi_square, check.degrees_of_freedom)),
              told(words("noise of a touch, as the reference scatters"),
                   words.or_dash(check.noise_um, "{:.1f} µm")),
              told(words("growth of the arm's lengths since the reference"), growth_text(words, check)),
              told(words("warmth that the growth stands for"), warmth_text(words, check.warmer_k)),
              told(words("reference"),
                   words("{} of {} checks", check.reference.count, check.reference.needed)),
              told(words("touches"), touches_text(words, check.touch_count, check.complete))}) +
         (joints.empty() ? std::string() : offsets);
}

std::string deviation_figures(const Words& words, const VerificationReport& report,
                              const DeviationWords& deviation) {
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
    series.name = words("touch");
    drawn += svg(words, {.title = words("Plane {}", plane),
                         .x_label = words("number of the touch"),
                         .y_label = words(deviation.axis),
                         .series = {series},
                         .level = 0.0,
                         .level_name = words(deviation.level),
                         .x_range = std::pair(1.0, static_cast<double>(report.touches.size())),
                         .y_range = std::pair(-reach_um, reach_um)});
  }
  return drawn.empty() ? html::paragraph(words("Without a verdict there is nothing to show.")) : drawn;
}

std::string verifying_touches_table(const Words& words, const VerificationReport& report,
                                    const DeviationWords& deviation) {
  std::vector<Row> rows;
  for (const VerificationReport::Touch& touch : report.touches)
    rows.push_back({std::to_string(touch.touch), std::to_string(touch.plane),
                    words.or_dash(touch.deviation_mm, "{:+.4f}"), words.numbers(touch.joints_deg),
                    words.known(touch.captured_at)});
  return html::table(
      words, words("Touches"),
      {words("touch"), words("plane"), words(deviation.column), words("joints °"), words("made")}, rows);
}

}  // namespace cell
