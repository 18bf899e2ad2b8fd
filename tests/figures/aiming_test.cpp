// Whole runs, touch by touch, of arms that are up to twice as far off as Table III's: the core aims, the
// simulated cell's own geometry says what is met. No sockets.
#include <gtest/gtest.h>

#include <chrono>
#include <cstdio>
#include <random>

#include "calib_core/geometry/units.hpp"
#include "calib_core/numerics/uniform_chance.hpp"
#include "calib_core/planning/aimed_touch.hpp"
#include "calib_core/planning/aimed_transfer.hpp"
#include "calib_core/planning/online_estimate.hpp"
#include "calib_core/planning/touch_feasibility.hpp"
#include "calib_core/planning/touch_planning.hpp"
#include "sim_controller/motion.hpp"
#include "sim_controller/plant.hpp"
#include "sim_controller/world.hpp"
#include "tests/calib_core/paper.hpp"
#include "tests/figures/simulated_cell.hpp"
#include "tests/sim_controller/whole_path.hpp"

namespace calib::figures {
namespace {

constexpr int kRunCount = 200;
constexpr double kNominalMissMetres = 0.026;
/// Of the touches that may miss by more than the three standard deviations predicted of them.
constexpr double kBeyondShareMax = 0.003;

cell::Cell cell_that_misses_much() {
  cell::Cell cell = shipped_cell("demo");
  cell.nominal_position_error_m = kNominalMissMetres;
  cell.unknown_place_std = {kNominalMissMetres, kNominalMissMetres / kBlockPoseLeverMetres};
  return cell;
}

/// The touches of a quick run, planned once: the cell is the same for every arm.
struct Planned {
  cell::Cell cell = cell_that_misses_much();
  PlanningProblem problem;
  TouchPlan plan;

  Planned() {
    problem = cell::planning_problem(cell, cell.recipes.at("quick"));
    auto outcome = plan_touches(problem);
    if (const auto* failure = std::get_if<PlanningFailure>(&outcome))
      throw std::runtime_error("plane " + std::to_string(failure->face + 1) + ": " +
                               std::to_string(failure->found) + " of " + std::to_string(failure->wanted) +
                               ": " + failure->reason);
    plan = std::get<TouchPlan>(std::move(outcome));
  }
};

double worst_nominal_miss_m(const Planned& planned, const ErrorVector& errors) {
  const PreparedModel nominal = prepare(planned.problem.nominal);
  const PreparedModel truth = prepare(apply(planned.problem.nominal, errors));
  double worst_m = 0.0;
  for (const PlannedTouch& touch : planned.plan.touches) {
    for (const JointVector& joints : {touch.joints, touch.clear_joints}) {
      worst_m = std::max(worst_m, (forward_chain(nominal, joints).tip_in_block_m() -
                                   forward_chain(truth, joints).tip_in_block_m())
                                      .norm());
    }
  }
  return worst_m;
}

/// Table III's errors with other signs and up to twice as large, the others as large as they are in an
/// assembled arm; within the miss that the cell's file promises.
ErrorVector draw_arm(const Planned& planned, UniformChance& chance) {
  const ErrorVector table3 = paper::table3();
  ErrorVector errors;
  for (int i = 0; i < kErrorParameterCount; ++i) {
    const bool is_length = error_parameters()[static_cast<std::size_t>(i)].is_length();
    errors[i] = table3[i] == 0.0 ? (is_length ? 0.4e-3 : 1e-3) * study::normal(chance)
                                 : 2.0 * (2.0 * chance() - 1.0) * table3[i];
  }
  const double miss_m = worst_nominal_miss_m(planned, errors);
  return std::min(1.0, kNominalMissMetres / miss_m) * errors;
}

struct Flight {
  std::string trouble;              // "the forearm hit table on the way to touch 3"; empty: none
  std::vector<double> predicted_m;  // miss of each touch, as it was commanded
  std::vector<double> off_m;        // how far the true ball was from where the touch wanted it
  std::vector<double> searched_m;   // length of its search
  double learning_s = 0.0;          // of this machine, in Aim::add
};

/// One run as the daemon makes it: the next touch is aimed while the arm makes the one before, with all that
/// is known by then.
class SimulatedRun {
 public:
  SimulatedRun(const Planned& planned, const ErrorVector& errors, std::uint64_t seed)
      : planned_(planned),
        plant_(sim::make_plant(planned.cell, errors)),
        aim_(planned.problem),
        chance_(seed) {}

  Flight fly() {
    const std::size_t count = planned_.plan.touches.size();
    std::optional<AimedTouch> touch = prepare(0, {planned_.problem.park_joints, std::nullopt, nullptr});
    for (std::size_t i = 0; i < count && touch && flight_.trouble.empty(); ++i) {
      sim::Path way = way_;
      learn();
      std::optional<AimedTouch> next;
      if (i + 1 < count) next = prepare(i + 1, transfer_end_of(*touch));
      const std::string name =
          " touch " + std::to_string(i + 1) + " on plane " + std::to_string(touch->touch.face + 1);
      travel(way, "on the way to" + name);
      travel({touch->touch.clear_joints, touch->touch.approach_joints}, "in the approach of" + name);
      if (flight_.trouble.empty()) search(*touch, name);
      touch = std::move(next);
    }
    return flight_;
  }

 private:
  void learn() {
    const auto start = std::chrono::steady_clock::now();
    if (captured_) aim_.add(*captured_);
    captured_.reset();
    flight_.learning_s += std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  }

  std::optional<AimedTouch> prepare(std::size_t index, const TransferEnd& from) {
    const PlannedTouch& planned = planned_.plan.touches[index];
    for (auto made : {aim_touch(planned_.problem, aim_, planned), nominal_touch(planned_.problem, planned)}) {
      auto* aimed = std::get_if<AimedTouch>(&made);
      if (!aimed) continue;
      const auto via = find_aimed_transfer(planned_.problem, aim_, from, transfer_end_of(*aimed));
      if (!via) continue;
      way_ = {from.joints};
      way_.insert(way_.end(), via->begin(), via->end());
      way_.push_back(aimed->touch.clear_joints);
      return std::move(*aimed);
    }
    flight_.trouble = "touch " + std::to_string(index + 1) + " can neither be aimed nor made as planned";
    return std::nullopt;
  }

  void travel(const sim::Path& path, const std::string& where) {
    if (!flight_.trouble.empty()) return;
    if (const auto hit = sim::testing::find_hit(plant_, path, 1.0)) {
      flight_.trouble = "the " + hit->clash.body + " hit " + hit->clash.other + " " + where;
    } else if (sim::testing::find_trip(plant_, path, 0.0)) {
      flight_.trouble = "the ball touched something " + where;
    }
  }

  void search(const AimedTouch& aimed, const std::string& name) {
    const PlannedTouch& touch = aimed.touch;
    const double noise_m = planned_.cell.touch_noise_m * sim::gaussian(chance_);
    const sim::ToolPath line = sim::straight_line(plant_, touch.approach_joints, touch.search_end_joints);
    const auto trip = sim::testing::find_trip(plant_, line.path, noise_m);
    if (!trip || *trip <= 0.0) {
      flight_.trouble = "no face was met by" + name;
      return;
    }
    if (const auto hit = sim::testing::find_hit(plant_, line.path, *trip))
      flight_.trouble = "the " + hit->clash.body + " hit " + hit->clash.other + " in the search of" + name;
    captured_ = Touch{.face = touch.face, .joints = sim::posture(line.path, *trip)};
    const Face& face = planned_.problem.faces[static_cast<std::size_t>(touch.face)];
    const Eigen::Vector3d ball_m = forward_chain(plant_.truth, captured_->joints).tip_in_block_m();
    if (std::abs(signed_distance_m(contact_plane(face, planned_.problem.stylus), ball_m)) >
        6.0 * planned_.cell.touch_noise_m)
      flight_.trouble = "another face was met by" + name;
    flight_.predicted_m.push_back(touch.predicted_position_error_m);
    flight_.searched_m.push_back(line.length_m);
    flight_.off_m.push_back((forward_chain(aimed.problem.nominal, touch.joints).tip_in_block_m() -
                             forward_chain(plant_.truth, touch.joints).tip_in_block_m())
                                .norm());
  }

  const Planned& planned_;
  sim::Plant plant_;
  OnlineArmEstimate aim_;
  std::mt19937_64 chance_;
  sim::Path way_;                  // to the touch prepared last
  std::optional<Touch> captured_;  // not learnt yet
  Flight flight_;
};

double share_of(const std::vector<double>& sorted, double share) {
  return sorted[static_cast<std::size_t>(share * static_cast<double>(sorted.size() - 1))];
}

TEST(FiguresOfAiming, ArmsUpToTwiceAsFarOffAsTable3sMeetEveryFaceAndNothingElse) {
  const Planned planned;
  const std::size_t count = planned.plan.touches.size();
  std::vector<std::vector<double>> off_m(count), predicted_m(count);
  double searched_m = 0.0, learning_s = 0.0;
  int beyond = 0;
  for (int run = 1; run <= kRunCount; ++run) {
    const auto seed = static_cast<std::uint64_t>(run);
    UniformChance chance(seed);
    const Flight flight = SimulatedRun(planned, draw_arm(planned, chance), seed).fly();
    EXPECT_EQ(flight.trouble, "") << "seed " << seed;
    ASSERT_EQ(flight.off_m.size(), count) << "seed " << seed;
    learning_s += flight.learning_s;
    for (std::size_t i = 0; i < count; ++i) {
      off_m[i].push_back(flight.off_m[i]);
      predicted_m[i].push_back(flight.predicted_m[i]);
      searched_m += flight.searched_m[i];
      beyond += flight.off_m[i] > flight.predicted_m[i];
    }
  }
  for (std::size_t i = 0; i < count; ++i) {
    std::ranges::sort(off_m[i]);
    std::ranges::sort(predicted_m[i]);
    std::printf(
        "touch %2zu: missed by %5.2f mm in the median, %5.2f (95 %%), %5.2f at worst; predicted %5.2f mm\n",
        i + 1, mm_from_metres(share_of(off_m[i], 0.5)), mm_from_metres(share_of(off_m[i], 0.95)),
        mm_from_metres(off_m[i].back()), mm_from_metres(share_of(predicted_m[i], 0.5)));
  }
  const double touches = static_cast<double>(count) * kRunCount;
  const TouchHeights unaimed = touch_heights(kNominalMissMetres, planned.problem.standoff_min_m);
  const double unaimed_m = unaimed.approach_m - unaimed.search_end_m;
  const double saved_s = 0.5 * (unaimed_m - searched_m / touches) / planned.problem.motion.search_m_s;
  std::printf(
      "%d of %.0f touches missed by more than predicted; a search is %.1f mm long, %.1f with the nominal "
      "miss: "
      "%.1f s less a touch; %.2f ms to learn from one\n",
      beyond, touches, mm_from_metres(searched_m / touches), mm_from_metres(unaimed_m), saved_s,
      1e3 * learning_s / touches);
  EXPECT_LE(beyond, kBeyondShareMax * touches);
}

}  // namespace
}  // namespace calib::figures
