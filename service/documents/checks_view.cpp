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

namespace cell {
namespace {

struct Quantity {
  std::string name;
  std::string words;
  std::string unit;
  std::string remedy;
  std::function<std::optional<double>(const CheckDocument&)> of;
};

std::vector<Quantity> charted_quantities() {
  const std::string mend = "look at the chart, find out what has changed, and calibrate anew if it goes on";
  std::vector<Quantity> all;
  for (const int joint : calib::kCheckedJoints) {
    const auto offset = [joint](const CheckDocument& check) {
      const auto found = std::ranges::find(check.joints, joint, &CheckDocument::Joint::joint);
      return found == check.joints.end() ? std::nullopt : found->offset_mrad;
    };
    all.push_back(
        {fmt::format("joint_{}", joint), fmt::format("the offset of joint {}", joint), "mrad", mend, offset});
  }
  all.push_back({"growth", "the growth of the arm", "ppm",
                 "the arm is not as warm as then; warm it up as for those checks, or compensate with the "
                 "growth of this one",
                 [](const CheckDocument& check) { return check.growth_ppm; }});
  all.push_back({"residual", "what the arm's growth leaves", "mm", mend,
                 [](const CheckDocument& check) { return check.rms_mm; }});
  return all;
}

/// Those that the charts are of.
std::vector<const EndedCheck*> charted(const std::vector<EndedCheck>& checks) {
  std::vector<const EndedCheck*> chosen;
  for (const EndedCheck& check : checks) {
    if (!check.result.verdict.accepted) continue;
    const bool is_base = std::ssize(chosen) < calib::kChartBaseCount;
    if (*check.result.verdict.accepted || !is_base) chosen.push_back(&check);
  }
  return chosen;
}

ChecksDocument::Point point_told(const calib::ChartPoint& point, const EndedCheck& check) {
  ChecksDocument::Point made{.run = std::to_string(check.run.id),
                             .value = finite(point.value),
                             .beyond_shewhart = point.is_beyond_shewhart,
                             .beyond_ewma = point.is_beyond_ewma};
  if (!point.mean) return made;
  made.weighted_mean = finite(*point.mean);
  made.shewhart_limit = finite(point.shewhart_limit);
  made.ewma_limit = finite(point.ewma_limit);
  return made;
}

ChecksDocument::Chart chart_of(const Quantity& quantity, const std::vector<const EndedCheck*>& checks) {
  std::vector<double> values;
  std::vector<const EndedCheck*> measured;
  for (const EndedCheck* check : checks) {
    const auto value = quantity.of(check->result);
    if (!value) continue;
    values.push_back(*value);
    measured.push_back(check);
  }
  ChecksDocument::Chart chart{.quantity = quantity.name, .unit = quantity.unit, .centre = {}, .points = {}};
  const auto points = calib::control_chart(values);
  std::ranges::transform(
      points, measured, std::back_inserter(chart.points),
      [](const calib::ChartPoint& point, const EndedCheck* check) { return point_told(point, *check); });
  if (!points.empty() && points.back().mean) chart.centre = finite(points.back().centre);
  return chart;
}

void warn_of(const Quantity& quantity, const ChecksDocument::Chart& chart, ChecksDocument& document) {
  if (chart.points.empty() || chart.points.back().run != document.checks.back().run) return;
  const ChecksDocument::Point& newest = chart.points.back();
  const auto add = [&](const char* what, double value, double limit) {
    document.warnings.push_back(
        fmt::format("run {}: {} {} by {:.3f} {} from the first {} checks, and chance explains {:.3f}: {}",
                    newest.run, quantity.words, what, value - *chart.centre, chart.unit,
                    calib::kChartBaseCount, limit, quantity.remedy));
  };
  if (newest.beyond_shewhart) {
    add("differs", *newest.value, *newest.shewhart_limit);
  } else if (newest.beyond_ewma) {
    add("creeps, its weighted mean being away", *newest.weighted_mean, *newest.ewma_limit);
  }
}

void tell_due(const StoredRun& calibration, const std::vector<EndedCheck>& checks, std::chrono::days every,
              std::chrono::system_clock::time_point now, ChecksDocument& document) {
  document.every_days = static_cast<int>(every.count());
  const StoredRun& last = checks.empty() ? calibration : checks.back().run;
  const auto ended = time_from_utc(last.ended_at.value_or(""));
  if (!ended) return;
  const auto due = *ended + every;
  document.due_at = format_utc(due);
  document.overdue = now > due;
  if (*document.overdue)
    document.warnings.push_back(fmt::format("a check was due on {}: touchcal check", *document.due_at));
}

}  // namespace

ChecksDocument checks_view(const StoredRun& calibration, const std::vector<EndedCheck>& checks,
                           std::optional<std::chrono::days> every,
                           std::chrono::system_clock::time_point now) {
  ChecksDocument document;
  document.of_run = std::to_string(calibration.id);
  for (const EndedCheck& check : checks) {
    document.checks.push_back({.run = std::to_string(check.run.id),
                               .ended_at = check.run.ended_at.value_or(""),
                               .operator_name = check.run.operator_name,
                               .reference = check.run.verdict == Verdict::kNone,
                               .accepted = check.result.verdict.accepted,
                               .cause = check.result.cause,
                               .joint = check.result.joint});
  }
  document.reference = {
      .count = static_cast<int>(std::ranges::count(document.checks, true, &ChecksDocument::Check::reference)),
      .needed = calib::kReferenceCount};
  const auto chosen = charted(checks);
  document.base = {.count = static_cast<int>(std::min<std::size_t>(chosen.size(), calib::kChartBaseCount)),
                   .needed = calib::kChartBaseCount};
  for (const Quantity& quantity : charted_quantities()) {
    document.charts.push_back(chart_of(quantity, chosen));
    if (!document.checks.empty()) warn_of(quantity, document.charts.back(), document);
  }
  if (every) tell_due(calibration, checks, *every, now, document);
  return document;
}

}  // namespace cell
