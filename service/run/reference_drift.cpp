#include "service/run/reference_drift.hpp"

#include <cmath>

#include "calib_core/numerics/distributions.hpp"

namespace cell {
namespace {

constexpr double kConfidence = 0.997;

}  // namespace

ReferencePlace reference_place(const std::vector<double>& readings_m) {
  const auto line = calib::line_through(readings_m);
  if (!line) return {};
  ReferencePlace place{.scatter = line->scatter};
  const double significant = calib::student_two_sided_factor(kConfidence, line->scatter.degrees_of_freedom);
  const double squared = line->slope * line->slope;
  if (squared > significant * significant * line->variance_of_slope) {
    const auto steps = static_cast<double>(readings_m.size() - 1);
    place.trend_m = steps * std::sqrt(squared - line->variance_of_slope);
  }
  return place;
}

void note_references(const std::vector<calib::Touch>& at_place, calib::IdentificationProblem& problem) {
  const calib::PreparedModel nominal = prepare(problem.nominal);
  std::vector<double> readings_m;
  for (const calib::Touch& touch : calib::counted_readings(at_place)) {
    const calib::ContactSurface& surface =
        problem.artefact.contact_planes.at(static_cast<std::size_t>(touch.face));
    readings_m.push_back(signed_distance_m(surface, forward_chain(nominal, touch.joints).tip_in_block_m()));
  }
  const ReferencePlace place = reference_place(readings_m);
  problem.drift_m = place.trend_m;
  problem.pure_error = place.scatter;
}

}  // namespace cell
