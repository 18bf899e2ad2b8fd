#include "service/run/run_repeats.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <span>
#include <utility>

#include "calib_core/geometry/units.hpp"
#include "config/utc_text.hpp"
#include "service/run/reference_drift.hpp"
#include "service/run/run.hpp"
#include "service/run/touch_command.hpp"

namespace cell {
namespace {

using SystemTime = std::chrono::system_clock::time_point;

/// A clock that was set in between tells nonsense: no run takes a year.
constexpr double kRunSecondsMax = 3e7;

std::optional<double> seconds_since(const std::optional<SystemTime>& first, const std::string& at) {
  const auto time = time_from_utc(at);
  if (!first || !time) return std::nullopt;
  // Whole milliseconds, so that the text of a document is short and reads back exactly.
  const auto passed = std::chrono::duration_cast<std::chrono::milliseconds>(*time - *first);
  const double seconds = static_cast<double>(passed.count()) / 1e3;
  return seconds <= kRunSecondsMax ? std::optional(seconds) : std::nullopt;
}

/// Heights of what was touched, over the nominal faces by the nominal arm.
class Heights {
 public:
  explicit Heights(const calib::IdentificationProblem& problem)
      : nominal_(calib::prepare(problem.nominal)), faces_(problem.artefact.contact_planes) {}

  [[nodiscard]] double height_m(int face, const calib::JointVector& joints) const {
    return signed_distance_m(faces_.at(static_cast<std::size_t>(face)),
                             forward_chain(nominal_, joints).block_from_frame.back());
  }
  [[nodiscard]] std::vector<calib::PairDifference> differences(
      const std::vector<calib::ContactPair>& pairs) const {
    std::vector<calib::PairDifference> all;
    all.reserve(pairs.size());
    for (const calib::ContactPair& pair : pairs)
      all.push_back({pair.face, height_m(pair.face, pair.second) - height_m(pair.face, pair.first)});
    return all;
  }

 private:
  calib::PreparedModel nominal_;
  const std::vector<calib::ContactSurface>& faces_;
};

/// The least that readings of the place scatter by chance, at the joints of one of them.
double least_scatter_m(const calib::IdentificationProblem& problem, const calib::Touch& touch) {
  const calib::Chain chain = forward_chain(calib::prepare(problem.nominal), touch.joints);
  const calib::ContactSurface& surface =
      problem.artefact.contact_planes.at(static_cast<std::size_t>(touch.face));
  const calib::BallContact contact = contact_at(surface, chain.block_from_frame.back());
  const calib::JointVector slope =
      (contact.normal.transpose() * point_jacobian(problem.nominal, chain, contact.ball_m)).transpose();
  const double of_stops_m = slope.cwiseProduct(problem.stop_std_rad).norm();
  return std::max(calib::kProbeScatterMinMetres, calib::kStopScatterShareMin * of_stops_m);
}

/// The reference touches of one place after the other.
std::vector<std::span<const calib::Touch>> by_place(std::span<const calib::Touch> references) {
  std::vector<std::span<const calib::Touch>> series;
  for (std::size_t first = 0, end = 0; first < references.size(); first = end) {
    while (end < references.size() && references[end].face == references[first].face) ++end;
    series.push_back(references.subspan(first, end - first));
  }
  return series;
}

ReferencePlace place_of(std::span<const calib::Touch> references, std::span<const double> times_s,
                        const Heights& heights) {
  std::vector<double> readings_m, counted_s;
  for (const std::size_t index : calib::counted_indices(references)) {
    const calib::Touch& touch = references[index];
    readings_m.push_back(heights.height_m(touch.face, touch.joints));
    if (!times_s.empty()) counted_s.push_back(times_s[index]);
  }
  return reference_place(readings_m, counted_s);
}

ReferencePlace added(ReferencePlace sum, const ReferencePlace& place) {
  if (!place.scatter) return sum;
  if (!sum.scatter) return place;
  sum.trend_m += place.trend_m;
  sum.open_trend = {std::hypot(sum.open_trend.std_m, place.open_trend.std_m),
                    std::min(sum.open_trend.degrees_of_freedom, place.open_trend.degrees_of_freedom)};
  sum.scatter = calib::pooled(*sum.scatter, *place.scatter);
  return sum;
}

ReferencePlace places_of(const calib::Repeats& repeats, const Heights& heights) {
  const bool has_times = repeats.reference_times_s.size() == repeats.references.size();
  ReferencePlace sum;
  std::size_t first = 0;
  for (const auto series : by_place(repeats.references)) {
    const auto times_s = has_times ? std::span(repeats.reference_times_s).subspan(first, series.size())
                                   : std::span<const double>();
    sum = added(sum, place_of(series, times_s, heights));
    first += series.size();
  }
  return sum;
}

}  // namespace

TouchTimes times_of(const std::vector<StoredTouch>& touches, const std::vector<ReferenceTouch>& references) {
  std::optional<SystemTime> first;
  const auto note = [&first](const std::string& at) {
    const auto time = time_from_utc(at);
    if (time && (!first || *time < *first)) first = time;
  };
  for (const StoredTouch& touch : touches) note(touch.captured_at);
  for (const ReferenceTouch& touch : references) note(touch.captured_at);  // where a first touch was replaced
  TouchTimes times;
  for (const StoredTouch& touch : touches) times.touches_s.push_back(seconds_since(first, touch.captured_at));
  for (const ReferenceTouch& touch : references) {
    const auto at_s = seconds_since(first, touch.captured_at);
    const double before_s = times.references_s.empty() ? 0.0 : times.references_s.back();
    if (!at_s || *at_s < before_s) {
      times.references_s.clear();
      break;
    }
    times.references_s.push_back(*at_s);
  }
  return times;
}

std::optional<cs8::JointsMicrodeg> first_contact_of(const StoredTouch& touch) {
  const bool both_latched = touch.source == cs8::CaptureSource::kLatched && touch.first &&
                            touch.first->source == cs8::CaptureSource::kLatched;
  return both_latched ? std::optional(touch.first->joints) : std::nullopt;
}

calib::Repeats repeats_of(const std::vector<StoredTouch>& touches,
                          const std::vector<ReferenceTouch>& references,
                          const std::optional<calib::TouchNoise>& qualified, int faces_per_place) {
  calib::Repeats repeats{.references = to_touches(references, touches, faces_per_place),
                         .reference_times_s = times_of(touches, references).references_s,
                         .two_speed = {},
                         .touched_again = {},
                         .qualified = qualified};
  for (const StoredTouch& stored : touches) {
    const calib::Touch touch = to_touch(stored);
    if (touch.deviation_m != 0.0) continue;  // it says nothing of the others
    if (const auto first = first_contact_of(stored))
      repeats.two_speed.push_back({touch.face, from_wire(*first), touch.joints});
    if (stored.again) repeats.touched_again.push_back({touch.face, touch.joints, from_wire(*stored.again)});
  }
  return repeats;
}

void note_repeats(const calib::Repeats& repeats, calib::IdentificationProblem& problem) {
  const Heights heights(problem);
  ReferencePlace place = places_of(repeats, heights);
  problem.doubted_error.reset();
  if (place.scatter) {
    const double least_m = least_scatter_m(problem, repeats.references.front());
    if (calib::is_implausibly_small(*place.scatter, least_m)) {
      problem.doubted_error = std::exchange(place.scatter, std::nullopt);
      if (place.trend_m < least_m) place.trend_m = 0.0;
      place.open_trend = {};
    }
  }
  problem.drift_m = place.trend_m;
  problem.drift_uncertainty = place.open_trend;
  problem.repeat_sources = {};
  problem.repeat_sources.reference_touches.noise = place.scatter;
  problem.repeat_sources.two_speed.noise = calib::two_speed_noise(heights.differences(repeats.two_speed));
  auto again = calib::touched_again_noise(heights.differences(repeats.touched_again));
  if (again && calib::is_implausibly_small(*again, calib::kProbeScatterMinMetres)) again.reset();  // copies
  problem.repeat_sources.touched_again.noise = again;
  problem.repeat_sources.qualification.noise = repeats.qualified;
  problem.pure_error = calib::pure_error_of(problem.repeat_sources, problem.touch_noise_m);
}

}  // namespace cell
