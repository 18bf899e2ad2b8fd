#include "sim_controller/val3/language/instructions.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <set>

namespace val3 {
namespace {

Expression value_of(Kind kind) {
  Expression e{.kind = Expression::Kind::kName};
  e.type = {kind, -1};
  return e;
}

int fitting(std::string_view name, const std::vector<Kind>& kinds) {
  std::vector<Expression> arguments;
  for (const Kind kind : kinds) arguments.push_back(value_of(kind));
  return fitting_signature(*find_instruction(name), arguments);
}

TEST(Instructions, EachIsInTheTableOnceAndIsFoundByItsName) {
  std::set<std::string> names;
  for (const Instruction& one : all_instructions()) {
    EXPECT_TRUE(names.insert(one.name).second) << one.name;
    EXPECT_EQ(find_instruction(one.name), &one);
    EXPECT_FALSE(one.signatures.empty()) << one.name;
  }
  EXPECT_EQ(find_instruction("sine"), nullptr);
  EXPECT_EQ(find_instruction("SIN"), nullptr);
  EXPECT_EQ(find_instruction(""), nullptr);
}

TEST(Instructions, WhatNoManualHasIsOfAVersionBehindThemOrAnAddOn) {
  for (const Instruction& one : all_instructions()) {
    if (one.page5 != 0 || one.page6 != 0) continue;
    EXPECT_TRUE(one.since >= Version({7, 0, 0}) || !one.addon.empty()) << one.name;
  }
}

TEST(Instructions, WhatTheManualOfVersion5LacksCameLater) {
  for (const Instruction& one : all_instructions()) {
    if (one.page5 != 0 || !one.addon.empty()) continue;
    EXPECT_GE(one.since, Version({6, 0, 0})) << one.name;
  }
}

TEST(Instructions, OptionalParametersStandLast) {
  for (const Instruction& one : all_instructions())
    for (const Signature& signature : one.signatures)
      EXPECT_TRUE(std::ranges::is_partitioned(signature.parameters, [](const InstructionParameter& p) {
        return !p.optional;
      })) << one.name;
}

TEST(Instructions, WhatMayWaitIsKnown) {
  for (const std::string_view name : {"wait", "delay", "watch", "sioGet", "sioSet", "waitEndMove", "taskKill",
                                      "setMutex", "get", "open", "close", "disablePower"}) {
    EXPECT_TRUE(find_instruction(name)->may_block) << name;
    EXPECT_TRUE(find_instruction(name)->may_yield) << name;
  }
  for (const std::string_view name :
       {"clock", "herej", "isSettled", "stopMove", "resetMotion", "enablePower"})
    EXPECT_FALSE(find_instruction(name)->may_block) << name;
}

TEST(Instructions, ASignatureFitsByTheTypesOfItsArguments) {
  EXPECT_EQ(fitting("sin", {Kind::kNum}), 0);
  EXPECT_EQ(fitting("sin", {Kind::kString}), -1);
  EXPECT_EQ(fitting("sin", {}), -1);
  EXPECT_EQ(fitting("sin", {Kind::kNum, Kind::kNum}), -1);
  EXPECT_EQ(fitting("abs", {Kind::kJoint}), 1);
  EXPECT_EQ(fitting("movej", {Kind::kPoint, Kind::kTool, Kind::kMdesc}), 0);
  EXPECT_EQ(fitting("movel", {Kind::kJoint, Kind::kTool, Kind::kMdesc}), -1);
  EXPECT_EQ(fitting("workingMode", {}), 0);
  EXPECT_EQ(fitting("workingMode", {Kind::kNum}), 0);
  EXPECT_EQ(fitting("delete", {Kind::kString, Kind::kNum, Kind::kNum}), 0);
  EXPECT_EQ(fitting("delete", {Kind::kFrame}), 1);
  EXPECT_EQ(fitting("size", {Kind::kUser, Kind::kNum}), 1);
}

TEST(Instructions, AnInputGivesABoolAndIsNoVariableOfOne) {
  EXPECT_EQ(fitting("sel", {Kind::kDio, Kind::kNum, Kind::kNum}), 0);
  EXPECT_EQ(fitting("setMutex", {Kind::kDio}), -1);
  EXPECT_EQ(fitting("toNum", {Kind::kString, Kind::kAio, Kind::kBool}), -1);
}

TEST(Instructions, ValuesInBracesFitByTheirFields) {
  Expression joint{.kind = Expression::Kind::kBraces};
  joint.parts.assign(6, value_of(Kind::kNum));
  Expression trsf = joint;
  Expression config{.kind = Expression::Kind::kBraces};
  config.parts = {value_of(Kind::kShoulder), value_of(Kind::kElbow), value_of(Kind::kWrist)};
  Expression point{.kind = Expression::Kind::kBraces};
  point.parts = {trsf, config};
  const InstructionParameter& first = find_instruction("movej")->signatures[0].parameters[0];
  EXPECT_EQ(fitting_kind(first, joint), Kind::kJoint);
  EXPECT_EQ(fitting_kind(first, point), Kind::kPoint);
  joint.parts.push_back(value_of(Kind::kNum));
  EXPECT_EQ(fitting_kind(first, joint), Kind::kVoid);
}

}  // namespace
}  // namespace val3
