#include "service/store/run_kind.hpp"

#include <gtest/gtest.h>

namespace cell {
namespace {

TEST(RunKind, EveryNameLeadsBackAndAnotherTextToNothing) {
  EXPECT_EQ(run_kind_name(RunKind::kCalibration), "calibration");
  EXPECT_EQ(run_kind_name(RunKind::kProof), "proof");
  EXPECT_EQ(run_kind_name(RunKind::kCheck), "check");
  for (const RunKind kind : kRunKinds) EXPECT_EQ(run_kind_named(run_kind_name(kind)), kind);
  EXPECT_EQ(run_kind_named("prove"), std::nullopt);
  EXPECT_EQ(run_kind_named(""), std::nullopt);
}

}  // namespace
}  // namespace cell
