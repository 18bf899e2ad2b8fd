// Counts what is taken from the heap: Eigen calls malloc, the standard library operator new, which calls
// malloc here. The linker sends every malloc of this program's own objects to __wrap_malloc (see
// CMakeLists.txt).
#include <gtest/gtest.h>

#include <cstdlib>
#include <new>

#include "calib_core/identify.hpp"
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
  return {paper::nominal(), paper::planes(), study::with_noise(exact, study::kTouchNoiseMetres, chance)};
}

/// Of one identification that stops after so many iterations, converged or not.
int allocations_with(const IdentificationProblem& problem, int iterations_max) {
  const IdentificationOptions options{.iterations_max = iterations_max};
  const int before = allocations;
  const IdentificationResult result = identify(problem, options);
  const int taken = allocations - before;
  EXPECT_EQ(result.iterations.size(), static_cast<std::size_t>(iterations_max)) << result.message;
  return taken;
}

/// Not inlined: the compiler may leave out an allocation whose use it sees.
[[gnu::noipa]] std::vector<Touch> make_touches() { return std::vector<Touch>(10); }

TEST(Allocations, OfEigenAndOfTheStandardLibraryAreCounted) {
  const KinematicModel model = paper::nominal();
  const std::vector<Plane> planes = paper::planes();
  int before = allocations;
  const std::vector<Touch> touches = make_touches();
  EXPECT_EQ(allocations - before, 1);
  before = allocations;
  const Eigen::VectorXd distances = signed_distances_m(model, planes, touches);
  EXPECT_EQ(allocations - before, 1);
}

TEST(Allocations, DISABLED_IterationsAfterTheFirstTakeNone) {
  const IdentificationProblem problem = noisy_problem();
  const int after_two = allocations_with(problem, 2);
  EXPECT_EQ(allocations_with(problem, 3), after_two);
  EXPECT_EQ(allocations_with(problem, 4), after_two);
}

}  // namespace
}  // namespace calib
