#include "service/documents/checks_view.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <functional>
#include <iterator>

#include "calib_core/proof/check.hpp"
#include "calib_core/proof/control_chart.hpp"
#include "config/utc_text.hpp"
#include "service/base/utc_time.hpp"
#include "service/documents/figures.hpp"
#include "service/run/verification.hpp"

namespace cell {
namespace {

/// A figure that is charted, and what to do about one beyond its limit.
struct Quantity {
  std::string name;
  std::string words;
  std::string unit;
  std::string remedy_above, remedy_below;
  bool is_bad_below;
  std::function<std::optional<double>(const CheckDocument&)> of;
};

std::vector<Quantity> charted_quantities() {
  const std::string changed = "find out what has changed, and calibrate anew";
  std::vector<Quantity> all;
  for (const int joint : calib::kCheckedJoints) {
    const auto offset = [joint](const CheckDocument& check) {
      const auto found = std::ranges::find(check.joints, joint, &CheckDocument::Joint::joint);
      return found == check.joints.end() ? std::nullopt : found->offset_mrad;
    };
    all.push_back({fmt::format("joint_{}", joint), fmt::format("the offset of joint {}", joint), "mrad",
                   changed, changed, true, offset});
  }
  all.push_back({"growth", "the growth of the arm", "ppm",
                 "the arm is warmer than at those checks: compensate with the growth of this one",
                 "the arm is colder than at those checks: warm it up as then", true,
                 [](const CheckDocument& check) { return check.growth_ppm; }});
  all.push_back({"residual", "the change that the arm's growth does not explain", "mm", changed, "", false,
                 [](const CheckDocument& check) { return check.rms_mm; }});
  return all;
}

/// Below its centre a value is beyond a limit only where that is bad.
ChecksDocument::Point point_told(const calib::ChartPoint& point, const EndedCheck& check, bool is_bad_below) {
  const auto counts = [&](double value) { return is_bad_below || value > point.centre.value_or(value); };
  ChecksDocument::Point made{.run = std::to_string(check.run.id), .value = finite(point.value)};
  made.beyond_shewhart = point.is_beyond_shewhart && counts(point.value);
  made.beyond_ewma = point.is_beyond_ewma && counts(point.mean.value_or(point.value));
  if (point.shewhart_limit) made.shewhart_limit = finite(*point.shewhart_limit);
  if (point.mean) made.weighted_mean = finite(*point.mean);
  if (point.ewma_limit) made.ewma_limit = finite(*point.ewma_limit);
  return made;
}

/// Of the checks with a verdict. One that alarms is shown, and changes nothing of the others.
ChecksDocument::Chart chart_of(const Quantity& quantity, const std::vector<EndedCheck>& checks) {
  std::vector<calib::ChartedValue> values;
  std::vector<const EndedCheck*> measured;
  for (const EndedCheck& check : checks) {
    const auto value = quantity.of(check.result);
    if (!value || !check.result.verdict.accepted) continue;
    values.push_back({*value, *check.result.verdict.accepted});
    measured.push_back(&check);
  }
  ChecksDocument::Chart chart{.quantity = quantity.name, .unit = quantity.unit, .centre = {}, .points = {}};
  const auto points = calib::control_chart(values);
  std::ranges::transform(points, measured, std::back_inserter(chart.points),
                         [&](const calib::ChartPoint& point, const EndedCheck* check) {
                           return point_told(point, *check, quantity.is_bad_below);
                         });
  if (!points.empty() && points.back().centre) chart.centre = finite(*points.back().centre);
  return chart;
}

void warn_of(const Quantity& quantity, const ChecksDocument::Chart& chart, const EndedCheck& newest_check,
             ChecksDocument& document) {
  if (chart.points.empty() || chart.points.back().run != std::to_string(newest_check.run.id)) return;
  const ChecksDocument::Point& newest = chart.points.back();
  const auto add = [&](const char* what, double value, double limit) {
    const double away = value - *chart.centre;
    document.warnings.push_back(fmt::format(
        "run {}: {} {} by {:.3f} {} from the first {} checks, and chance explains {:.3f}: check again; if it "
        "stays so, {}",
        newest.run, quantity.words, what, away, chart.unit, calib::kChartBaseCount, limit,
        away > 0.0 ? quantity.remedy_above : quantity.remedy_below));
  };
  if (newest.beyond_shewhart) {
    add("differs", *newest.value, *newest.shewhart_limit);
  } else if (newest.beyond_ewma) {
    add("creeps, its weighted mean being away", *newest.weighted_mean, *newest.ewma_limit);
  }
}

/// Of the newest check with a verdict. One that alarms says itself what has changed: where each joint seems
/// to be then is no news.
void warn_of_newest(const std::vector<Quantity>& quantities, const std::vector<EndedCheck>& checks,
                    ChecksDocument& document) {
  const EndedCheck* found = newest_judged(checks);
  if (!found) return;
  const EndedCheck& newest = *found;
  if (newest.result.verdict.accepted == false) {
    for (const std::string& reason : newest.result.verdict.reasons)
      document.warnings.push_back(fmt::format("run {}: {}", newest.run.id, reason));
    return;
  }
  for (std::size_t i = 0; i < quantities.size(); ++i)
    warn_of(quantities[i], document.charts[i], newest, document);
}

/// One that says something of the cell: it has a verdict, or is part of the reference.
bool says_something(const ChecksDocument::Check& check) {
  return check.reference || check.accepted.has_value();
}

void tell_due(const StoredRun& calibration, std::chrono::days every,
              std::chrono::system_clock::time_point now, ChecksDocument& document) {
  document.every_days = static_cast<int>(every.count());
  const auto newest = std::ranges::find_if(document.checks.rbegin(), document.checks.rend(), says_something);
  const bool was_checked = newest != document.checks.rend();
  const std::string last = was_checked ? newest->ended_at : calibration.ended_at.value_or("");
  const auto ended = time_from_utc(last);
  if (!ended) return;
  if (*ended > now) {
    document.warnings.push_back(
        fmt::format("when the next check is due is not known: the clock of the daemon is at {}, and run {} "
                    "ended at {}; set the clock",
                    format_utc(now), was_checked ? newest->run : document.of_run, last));
    return;
  }
  document.due_at = format_utc(*ended + every);
  document.overdue = now > *ended + every;
}

void mark_reference(const std::vector<EndedCheck>& checks, const calib::KinematicModel& arm,
                    std::vector<ChecksDocument::Check>& told) {
  std::vector<ReferenceCandidate> candidates;
  std::vector<std::size_t> places;
  for (std::size_t i = 0; i < checks.size(); ++i) {
    if (!may_be_reference(checks[i].run)) continue;
    candidates.push_back({checks[i].run.id, {checks[i].touches}});
    places.push_back(i);
  }
  for (const std::size_t chosen : reference_among(arm, candidates)) told[places[chosen]].reference = true;
}

std::vector<ChecksDocument::Check> checks_told(const std::vector<EndedCheck>& checks,
                                               const calib::KinematicModel& arm) {
  std::vector<ChecksDocument::Check> told;
  for (const EndedCheck& check : checks)
    told.push_back({.run = std::to_string(check.run.id),
                    .ended_at = check.run.ended_at.value_or(""),
                    .operator_name = check.run.operator_name,
                    .accepted = check.result.verdict.accepted,
                    .cause = check.result.cause,
                    .joint = check.result.joint});
  mark_reference(checks, arm, told);
  return told;
}

}  // namespace

const EndedCheck* newest_judged(const std::vector<EndedCheck>& checks) {
  const auto found = std::find_if(checks.rbegin(), checks.rend(), [](const EndedCheck& check) {
    return check.result.verdict.accepted.has_value();
  });
  return found == checks.rend() ? nullptr : &*found;
}

ChecksDocument checks_view(const StoredRun& calibration, const std::vector<EndedCheck>& checks,
                           const calib::KinematicModel& arm, std::optional<std::chrono::days> every,
                           std::chrono::system_clock::time_point now) {
  ChecksDocument document;
  document.of_run = std::to_string(calibration.id);
  document.count = static_cast<int>(std::ssize(checks));
  document.checks = checks_told(checks, arm);
  document.reference = {
      .count = static_cast<int>(std::ranges::count(document.checks, true, &ChecksDocument::Check::reference)),
      .needed = calib::kReferenceCount};
  const auto within = std::ranges::count(document.checks, true, &ChecksDocument::Check::accepted);
  document.base = {.count = static_cast<int>(std::min<std::ptrdiff_t>(within, calib::kChartBaseCount)),
                   .needed = calib::kChartBaseCount};
  const auto quantities = charted_quantities();
  for (const Quantity& quantity : quantities) document.charts.push_back(chart_of(quantity, checks));
  warn_of_newest(quantities, checks, document);
  if (every) tell_due(calibration, *every, now, document);
  return document;
}

void keep_newest(ChecksDocument& document, std::size_t limit) {
  if (document.checks.size() <= limit) return;
  document.checks.erase(document.checks.begin(), document.checks.end() - static_cast<std::ptrdiff_t>(limit));
  // Points are in the order of the checks: those before the first of a check that is kept go.
  const auto is_kept = [&](const ChecksDocument::Point& point) {
    return std::ranges::find(document.checks, point.run, &ChecksDocument::Check::run) !=
           document.checks.end();
  };
  for (ChecksDocument::Chart& chart : document.charts)
    chart.points.erase(chart.points.begin(), std::ranges::find_if(chart.points, is_kept));
}

}  // namespace cell
