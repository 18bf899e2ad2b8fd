// What hides behind a common stretch of all lengths, a hundred seeds each: arms as the maker's tolerances
// allow, touches of declared noise, an artefact within its certificate but for the one thing that is wrong.
#include <gtest/gtest.h>

#include <cstdio>

#include "calib_core/column_choice.hpp"
#include "calib_core/tip_uncertainty.hpp"
#include "calib_core/units.hpp"
#include "tests/figures/simulated_cell.hpp"

namespace calib::figures {
namespace {

constexpr int kTouchCount = 100;
constexpr int kSeedsWrongMax = 1;
constexpr int kBlockOnly = 4;  // faces
constexpr int kWithPlate = 5;

/// Something that nobody wrote down happens to the artefact.
using Mishap = void (*)(ArtefactKnowledge& truth);

void nothing(ArtefactKnowledge& /*truth*/) {}
void ball_wrong_by_200_um(ArtefactKnowledge& truth) { truth.stylus.radius_m += 0.2e-3; }
void ball_wrong_by_100_um(ArtefactKnowledge& truth) { truth.stylus.radius_m += 0.1e-3; }
/// By the share that 0.2 mm are of the block's half.
void block_larger(ArtefactKnowledge& truth) {
  for (Face& face : truth.faces) face.plane.offset_m *= 1.0 + 0.2 / 75.0;
}
void block_100_k_warmer(ArtefactKnowledge& truth) { truth.warmer_than_20_c_k += 100.0; }

/// How far from where it was written down the block stands: its middle, and its turn about that.
struct Displacement {
  double shift_m = 0.0;
  double turn_rad = 0.0;
};
constexpr Displacement kPlacedByEye{0.004, 0.005};
constexpr Displacement kMoved{0.040, 0.020};

/// In any direction.
void move_block(std::vector<Plane>& planes, const Displacement& by, UniformChance& chance) {
  const auto direction = [&chance] {
    return Eigen::Vector3d(study::normal(chance), study::normal(chance), study::normal(chance)).normalized();
  };
  const Eigen::Vector3d middle_m(0, -0.075, 0);
  const Eigen::Vector3d shift_m = by.shift_m * direction();
  const Eigen::AngleAxisd turn(by.turn_rad, direction());
  for (Plane& plane : planes) {
    const double from_middle_m = plane.offset_m - plane.outward.dot(middle_m);
    plane.outward = turn * plane.outward;
    plane.offset_m = from_middle_m + plane.outward.dot(middle_m + shift_m);
  }
}

struct Case {
  const char* name;
  int face_count;
  Mishap mishap;
  bool alarm_wanted;
  Displacement displacement = kPlacedByEye;
};

/// The demo cell without the faces after `face_count`.
cell::Cell cell_with_faces(int face_count) {
  cell::Cell cell = shipped_cell("demo");
  cell.block.faces.resize(static_cast<std::size_t>(face_count));
  cell.block.face_uncertainties.resize(static_cast<std::size_t>(face_count));
  std::erase_if(cell.block.lengths, [&](const KnownLength& length) {
    return length.faces[0] >= face_count || length.faces[1] >= face_count;
  });
  return cell;
}

class ScaleGuard : public ::testing::TestWithParam<Case> {};

TEST_P(ScaleGuard, WarnsWhenItShouldInNinetyNineOfAHundredSeeds) {
  const Case& one = GetParam();
  const cell::Cell cell = cell_with_faces(one.face_count);
  const cell::Recipe& recipe = cell.recipes.at("edf-25");
  IdentificationProblem problem = cell::identification_problem(cell, recipe);
  int alarms = 0;
  std::vector<double> significances;
  for (int seed = 1; seed <= kSeedCount; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    UniformChance chance(static_cast<std::uint64_t>(seed));
    DrawnArtefact drawn = draw_artefact(cell::artefact_knowledge(cell), chance);
    one.mishap(drawn.truth);
    Truth truth{apply(cell.arm.model, draw_errors(cell.arm.std_errors, chance)),
                describe(drawn.truth).contact_planes};
    move_block(truth.contact_planes, one.displacement, chance);
    problem.artefact = describe(drawn.known);
    problem.touches =
        captured(truth, even_touches(cell, one.face_count, kTouchCount / one.face_count, chance),
                 cell.touch_noise_m, chance);
    const IdentificationResult result = identify(problem, recipe.identification);
    ASSERT_EQ(result.status, IdentificationStatus::kConverged) << result.message;
    ASSERT_TRUE(result.scale);
    significances.push_back(result.scale->significance.value_or(0.0));
    if (result.scale->warning.empty()) {
      if (one.alarm_wanted) std::printf("  seed %d: no alarm (%.2f)\n", seed, significances.back());
      continue;
    }
    ++alarms;
    if (!one.alarm_wanted) std::printf("  seed %d: %s\n", seed, result.scale->warning.c_str());
    for (const char* suspect : {"stylus radius", "pre-travel", "size", "temperature"}) {
      EXPECT_NE(result.scale->warning.find(suspect), std::string::npos) << result.scale->warning;
    }
  }
  const int wrong = one.alarm_wanted ? kSeedCount - alarms : alarms;
  EXPECT_LE(wrong, kSeedsWrongMax);
  std::printf("scale, %s: %d alarms in %d seeds, stretch %.1f standard deviations (median)\n", one.name,
              alarms, kSeedCount, median(significances));
}

INSTANTIATE_TEST_SUITE_P(
    Cases, ScaleGuard,
    ::testing::Values(Case{"AllAsWrittenDown", kBlockOnly, nothing, false},
                      Case{"BallWrongByTwoTenths", kBlockOnly, ball_wrong_by_200_um, true},
                      Case{"BlockOfAnotherSize", kBlockOnly, block_larger, true},
                      Case{"BlockHundredKelvinWarmer", kBlockOnly, block_100_k_warmer, true},
                      Case{"BlockMovedAlone", kBlockOnly, nothing, false, kMoved},
                      Case{"AllAsWrittenDownWithPlate", kWithPlate, nothing, false},
                      Case{"BallWrongByOneTenthWithPlate", kWithPlate, ball_wrong_by_100_um, true},
                      Case{"BlockMovedAloneWithPlate", kWithPlate, nothing, false, kMoved}),
    [](const auto& info) { return std::string(info.param.name); });

TEST(ScaleGuard, FlagsTableIII) {
  const cell::Cell cell = shipped_cell("edf");
  const cell::Recipe& recipe = cell.recipes.at("edf-25");
  IdentificationProblem problem = cell::identification_problem(cell, recipe);
  int alarms = 0;
  for (int seed = 1; seed <= kSeedCount; ++seed) {
    UniformChance chance(static_cast<std::uint64_t>(seed));
    const Truth truth{apply(cell.arm.model, paper::table3()), problem.artefact.contact_planes};
    problem.touches = captured(truth, even_touches(cell, kBlockOnly, kTouchCount / kBlockOnly, chance),
                               cell.touch_noise_m, chance);
    const IdentificationResult result = identify(problem, recipe.identification);
    ASSERT_EQ(result.status, IdentificationStatus::kConverged) << result.message;
    if (!result.scale->warning.empty()) ++alarms;
    if (seed == 1) std::printf("scale, Table III: %s\n", result.scale->warning.c_str());
  }
  EXPECT_EQ(alarms, kSeedCount);
}

}  // namespace
}  // namespace calib::figures
