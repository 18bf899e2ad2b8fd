#include "sim_controller/val3/program/run_memory.hpp"

#include <gtest/gtest.h>

#include "tests/sim_controller/val3/small_application.hpp"

namespace val3 {
namespace {

std::size_t bytes_of(SmallApplication& small, std::string_view type, std::vector<std::size_t> sizes) {
  Program program{.name = "p", .file = {}, .parameters = {}, .locals = {}, .lines = {}};
  program.locals.push_back(small.declared(type, "l", std::move(sizes)));
  return bytes_of_call(small.application, program) - kCallBytes - kVariableBytes;
}

TEST(RunMemory, OfALocalIsThatOfItsElements) {
  SmallApplication small;
  EXPECT_EQ(bytes_of(small, "num", {1}), 8U);
  EXPECT_EQ(bytes_of(small, "num", {100'000}), 800'000U);
  EXPECT_EQ(bytes_of(small, "bool", {3, 5}), 15U);
  EXPECT_EQ(bytes_of(small, "string", {2}), 32U);
  EXPECT_EQ(bytes_of(small, "dio", {1}), 8U);
  EXPECT_EQ(bytes_of(small, "jointRx", {1}), 48U);
  EXPECT_EQ(bytes_of(small, "trsf", {1}), 48U);
  EXPECT_EQ(bytes_of(small, "pointRx", {1}), 48U + 3U + 8U);
  EXPECT_EQ(bytes_of(small, "frame", {1}), 48U + 8U);
  EXPECT_EQ(bytes_of(small, "mdesc", {1}), 7U * 8U + 1U);
  EXPECT_EQ(bytes_of(small, "num", {}), 0U) << "a collection has no elements at first";
}

TEST(RunMemory, OfAUserTypeIsThatOfItsFields) {
  SmallApplication small;
  UserType pair{.name = "pair", .fields = {}, .at = {}, .project = {}};
  pair.fields.push_back({.declared = small.declared("num", "x", {2}), .values = {}});
  pair.fields.push_back({.declared = small.declared("bool", "b", {1}), .values = {}});
  small.application.user_types.push_back(pair);
  EXPECT_EQ(bytes_of(small, "pair", {3}), 3U * (kVariableBytes + 16U + kVariableBytes + 1U));
}

TEST(RunMemory, OfAParameterByReferenceIsThatOfTheReference) {
  SmallApplication small;
  Program program{.name = "p", .file = {}, .parameters = {}, .locals = {}, .lines = {}};
  program.parameters = {small.reference("num", "x_n", 1), small.value("trsf", "x_t")};
  EXPECT_EQ(bytes_of_call(small.application, program), kCallBytes + kReferenceBytes + kVariableBytes + 48U);
}

TEST(RunMemory, OfATaskIsTheStackSizeAndTheUsualOneForNone) {
  Application application;
  application.stack_bytes = 15'000;
  EXPECT_EQ(run_memory_of(application), 15'000U);
  application.stack_bytes = 0;
  EXPECT_EQ(run_memory_of(application), kUsualStackBytes);
}

}  // namespace
}  // namespace val3
