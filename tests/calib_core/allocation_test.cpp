// Counts what is taken from the heap: Eigen calls malloc, the standard library operator new, which calls
// malloc here. The linker sends every malloc of this program's own objects to __wrap_malloc (see
// CMakeLists.txt).
#include <gtest/gtest.h>

#include <cstdlib>
#include <new>

#include "calib_core/compensation/compensation.hpp"
#include "calib_core/identification/identify.hpp"
#include "calib_core/kinematics/inverse_kinematics.hpp"
#include "tests/calib_core/block_study.hpp"

namespace {
int allocations = 0;
}

extern "C" {
void* __real_malloc(std::size_t size);
void* __real_calloc(std::size_t count, std::size_t size);
void* __real_realloc(void* block, std::size_t size);

void* __wrap_malloc(std::size_t size) {
  ++allocations;
  return __real_malloc(size);
}
void* __wrap_calloc(std::size_t count, std::size_t size) {
  ++allocations;
  return __real_calloc(count, size);
}
void* __wrap_realloc(void* block, std::size_t size) {
  ++allocations;
  return __real_realloc(block, size);
}
}

void* operator new(std::size_t size) {
  if (void* block = std::malloc(size)) return block;
  throw std::bad_alloc();
}
void operator delete(void* block) noexcept { std::free(block); }
void operator delete(void* block, std::size_t) noexcept { std::free(block); }

namespace calib {
namespace {

IdentificationProblem noisy_problem() {
  UniformChance chance(1);
  const KinematicModel truth = apply(paper::nominal(), study::draw_errors(chance));
  const auto exact = study::exact_touches(truth, study::kTouchesPerFace, chance);
  return {.nominal = paper::nominal(),
          .artefact = exact_artefact(paper::planes()),
          .touches = study::with_noise(exact, study::kTouchNoiseMetres, chance),
          .touch_noise_m = study::kTouchNoiseMetres};
}

/// Not inlined: the compiler may leave out an allocation whose use it sees.
[[gnu::noipa]] std::vector<Touch> make_touches() { return std::vector<Touch>(10); }

TEST(Allocations, OfEigenAndOfTheStandardLibraryAreCounted) {
  const KinematicModel model = paper::nominal();
  const std::vector<ContactSurface> planes = paper::planes();
  int before = allocations;
  const std::vector<Touch> touches = make_touches();
  EXPECT_EQ(allocations - before, 1);
  before = allocations;
  const Eigen::VectorXd distances = signed_distances_m(model, planes, touches);
  EXPECT_EQ(allocations - before, 1);
}

TEST(Allocations, IterationsAfterTheFirstTakeNone) {
  IdentificationProblem problem = noisy_problem();
  int before = allocations;
  const IdentificationResult from_nominal = identify(problem, {});
  const int taken_from_nominal = allocations - before;
  // Started where it ends, the same identification needs fewer iterations and everything else.
  problem.start = from_nominal.errors;
  before = allocations;
  const IdentificationResult from_its_end = identify(problem, {});
  EXPECT_EQ(allocations - before, taken_from_nominal);
  EXPECT_EQ(from_nominal.status, IdentificationStatus::kConverged) << from_nominal.message;
  EXPECT_EQ(from_its_end.status, IdentificationStatus::kConverged) << from_its_end.message;
  EXPECT_GE(from_nominal.iterations.size(), from_its_end.iterations.size() + 3);
}

TEST(Allocations, FindingPosturesWithoutASphericalWristTakesNone) {
  KinematicModel model = paper::nominal();
  model.links[5].r_m = 0.1;
  const Eigen::Isometry3d pose = forward_kinematics(model, JointVector::Constant(0.7));
  int before = allocations;
  const InverseKinematics inverse(model);
  EXPECT_GT(allocations, before);  // the table
  before = allocations;
  const Postures found = inverse.solve(pose);
  EXPECT_EQ(allocations, before);
  EXPECT_FALSE(found.empty());
}

TEST(Allocations, OfACompensatedTargetAreNone) {
  const KinematicModel truth = apply(paper::nominal(), paper::table3());
  ArmCovariance covariance = no_covariance();
  covariance.diagonal().setConstant(1e-8);
  const Compensation compensation({.nominal = paper::nominal(),
                                   .calibrated = truth,
                                   .joint_ranges = tx90::joint_ranges(),
                                   .covariance = covariance});
  const CompensationTool tool = stylus_tool(paper::nominal(), truth);
  const JointVector joints = tx90::degrees(20.0, 30.0, 60.0, 10.0, 50.0, -20.0);
  const int before = allocations;
  const Eigen::Isometry3d pose = compensation.nominal_world_from_tool(tool, joints);
  const CompensatedTarget by_joints = compensation.at_joints(tool, joints);
  const CompensatedTarget by_pose = compensation.at_pose(tool, pose, joints);
  EXPECT_EQ(allocations - before, 0);
  EXPECT_TRUE(by_joints.joints && by_joints.tip_std_m && by_pose.joints && by_pose.tip_std_m);
}

}  // namespace
}  // namespace calib
