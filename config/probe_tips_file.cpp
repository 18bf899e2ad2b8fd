#include "config/probe_tips_file.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string>
#include <utility>

#include "calib_core/geometry/units.hpp"
#include "config/config_error.hpp"
#include "config/short_name.hpp"

namespace cell {
namespace {

constexpr std::size_t kTipCountMax = 8;
/// No probe carries a longer star; further out is a typo.
constexpr double kTipCenterMaxMm = 200.0;
/// Further off it is another tip.
constexpr NumberRange kTipWithinMm{.min = kPositive.min, .max = 5.0};
constexpr NumberRange kTipRadiusStdMm{.min = 0.0, .max = 1.0};
/// Shorter is no direction.
constexpr double kTipDirectionMin = 1e-6;
/// A ball among the bodies is that of a tip when it lies, and is as large, to this much.
constexpr double kSameBallMetres = 1e-6;
/// A stem ends in its ball or no farther from it.
constexpr double kStemEndMetres = 2e-3;

Eigen::Vector3d tip_center_m(const JsonValue& value) {
  const Eigen::Vector3d center_mm = value.numbers<3>();
  if (center_mm.norm() > kTipCenterMaxMm)
    value.fail("is over " + plain_number(kTipCenterMaxMm) +
               " mm from the first tip's ball; give where the ball is in frame 7, in mm");
  return calib::kMetresPerMillimetre * center_mm;
}

Eigen::Vector3d tip_direction(const JsonValue& value) {
  const Eigen::Vector3d direction = value.numbers<3>();
  if (direction.norm() < kTipDirectionMin)
    value.fail("is no direction; give that of the tip's stem, out of the tip");
  return direction.normalized();
}

ProbeTip probe_tip_from_json(const JsonValue& value) {
  const JsonObject object =
      value.object({"name", "center_mm", "direction", "within_mm", "radius_mm", "std_radius_mm"});
  const JsonValue name = object.at("name");
  ProbeTip tip{.name = short_name(name),
               .center_m = tip_center_m(object.at("center_mm")),
               .direction = tip_direction(object.at("direction")),
               .within_m = object.metres("within", kTipWithinMm),
               .radius_m = object.metres("radius", kPositive),
               .std_radius_m = object.find_metres("std_radius", kTipRadiusStdMm).value_or(0.0)};
  if (tip.name == kFirstTip)
    name.fail(R"("first" is the tip whose ball is the origin of frame 7; give this one another name)");
  return tip;
}

/// Their centres being known to no better than `within_m`.
bool may_touch(const ProbeTip& a, const ProbeTip& b) {
  return (a.center_m - b.center_m).norm() <= a.radius_m + b.radius_m + a.within_m + b.within_m;
}

void demand_apart(const JsonValue& value, const ProbeTip& tip, const ProbeTip& other) {
  if (may_touch(tip, other))
    value.fail("its ball may touch that of the tip " + in_quotes(other.name) +
               R"(; correct "center_mm", "radius_mm" or "within_mm")");
}

void demand_ball(const JsonValue& value, const ProbeTip& tip, const Probe& probe) {
  const auto is_it = [&tip](const calib::Capsule& body) { return is_ball_of(tip, body); };
  if (std::ranges::any_of(probe.bodies, is_it)) return;
  value.fail(
      R"(its ball is not among "bodies"; add one with "from_mm" and "to_mm" both at this "center_mm" and with this "radius_mm")");
}

void demand_stem(const JsonValue& value, const ProbeTip& tip, const Probe& probe) {
  const auto is_it = [&tip](const calib::Capsule& body) { return is_stem_of(tip, body); };
  if (std::ranges::any_of(probe.bodies, is_it)) return;
  value.fail(R"(its stem is not among "bodies"; add one that ends within )" +
             plain_number(calib::mm_from_metres(kStemEndMetres)) + " mm of its ball");
}

void demand_ball_beyond_pretravel(const JsonValue& value, const ProbeTip& tip, const Probe& probe) {
  if (tip.radius_m > probe.stylus.pretravel_m) return;
  value.fail(R"(its ball is smaller than "pretravel_mm"; correct one of both)");
}

}  // namespace

bool is_ball_of(const ProbeTip& tip, const calib::Capsule& body) {
  return body.frame == calib::kFrameCount - 1 && body.from_m == body.to_m &&
         (body.from_m - tip.center_m).norm() <= kSameBallMetres &&
         std::abs(body.radius_m - tip.radius_m) <= kSameBallMetres;
}

bool is_stem_of(const ProbeTip& tip, const calib::Capsule& body) {
  const double from_center_m =
      std::min((body.from_m - tip.center_m).norm(), (body.to_m - tip.center_m).norm());
  return body.frame == calib::kFrameCount - 1 && body.from_m != body.to_m &&
         from_center_m <= tip.radius_m + kStemEndMetres;
}

void loosen_bodies(Probe& probe) {
  for (const ProbeTip& tip : probe.tips) {
    for (calib::Capsule& body : probe.bodies) {
      if (!is_ball_of(tip, body) && !is_stem_of(tip, body)) continue;
      body.margin_m = body.loose_m = std::max(body.loose_m, tip.within_m);
    }
  }
}

std::vector<ProbeTip> probe_tips_from_json(const JsonValue& value, const Probe& probe) {
  const ProbeTip first{.name = kFirstTip, .radius_m = probe.stylus.radius_m};
  std::vector<ProbeTip> tips;
  for (const JsonValue& item : value.items(1, kTipCountMax)) {
    ProbeTip tip = probe_tip_from_json(item);
    demand_apart(item, tip, first);
    for (const ProbeTip& other : tips) {
      if (other.name == tip.name)
        item.fail("the name " + in_quotes(tip.name) + " is there twice; name each tip differently");
      demand_apart(item, tip, other);
    }
    demand_ball(item, tip, probe);
    demand_stem(item, tip, probe);
    demand_ball_beyond_pretravel(item, tip, probe);
    tips.push_back(std::move(tip));
  }
  return tips;
}

}  // namespace cell
