#include "sim_controller/fault_names.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <map>
#include <set>
#include <sstream>

#include "config/config_error.hpp"
#include "cs8_protocol/names.hpp"

namespace sim {
namespace {

PlannedFault read(const std::string& line) {
  return planned(std::get<cell::DeclaredFault>(cell::parse_control_line(line)));
}

/// The place and the words of the refusal; empty when there is none.
std::string refusal(const std::string& line) {
  try {
    read(line);
  } catch (const cell::ConfigError& error) {
    return error.pointer() + " " + error.message();
  }
  return {};
}

TEST(FaultNames, SayWhatIsMeant) {
  const PlannedFault close = read(R"({"fault":"close","on":"touch_result","count":3})");
  EXPECT_EQ(std::get<LinkFault>(close.what).kind, Fault::kCloseSocket);
  EXPECT_EQ(std::get<cs8::MessageType>(close.on), cs8::MessageType::kTouchResult);
  EXPECT_EQ(close.nth, 3U);
  const PlannedFault late = read(R"({"fault":"delay","on":"accepted","count":"every","ms":100})");
  EXPECT_DOUBLE_EQ(std::get<LinkFault>(late.what).seconds, 0.1);
  EXPECT_TRUE(late.every);
  const PlannedFault silent = read(R"({"fault":"go_silent","on":"connection"})");
  EXPECT_TRUE(std::holds_alternative<AtConnection>(silent.on));
  EXPECT_EQ(silent.nth, 1U);
  const PlannedFault stuck = read(R"({"fault":"probe_stuck","touch":5,"phase":"retract"})");
  EXPECT_EQ(std::get<Trouble>(stuck.what).kind, TroubleKind::kStylusSticks);
  EXPECT_EQ(std::get<AtTouch>(stuck.on).phase, cs8::Phase::kRetract);
  EXPECT_EQ(stuck.nth, 5U);
  const PlannedFault dead = read(R"({"fault":"task_dies","touch":2,"error":150,"after_ms":40})");
  EXPECT_EQ(std::get<AtTouch>(dead.on).phase, cs8::Phase::kSearch);
  EXPECT_EQ(std::get<Trouble>(dead.what).number, 150);
  EXPECT_DOUBLE_EQ(dead.after_s, 0.04);
  EXPECT_TRUE(std::holds_alternative<AtOnce>(read(R"({"fault":"loop_cut"})").on));
}

TEST(FaultNames, WhatMakesNoSenseIsRefusedAtItsKey) {
  EXPECT_THAT(refusal(R"({"fault":"sabotage"})"), ::testing::StartsWith("/fault there is no fault"));
  EXPECT_THAT(refusal(R"({"fault":"drop","on":"letter"})"), ::testing::StartsWith("/on there is no message"));
  EXPECT_THAT(refusal(R"({"fault":"drop"})"), ::testing::HasSubstr("is one of a message"));
  EXPECT_THAT(refusal(R"({"fault":"drop","touch":3})"), ::testing::HasSubstr("is one of a message"));
  EXPECT_THAT(refusal(R"({"fault":"merge","on":"touch"})"), ::testing::StartsWith("/on "));
  EXPECT_THAT(refusal(R"({"fault":"wrong_arm","on":"state"})"), ::testing::StartsWith("/on "));
  EXPECT_THAT(refusal(R"({"fault":"drop","on":"touch","after_ms":3})"), ::testing::StartsWith("/after_ms "));
  EXPECT_THAT(refusal(R"({"fault":"delay","on":"touch"})"), ::testing::HasSubstr("wants \"ms\""));
  EXPECT_THAT(refusal(R"({"fault":"task_dies"})"), ::testing::HasSubstr("wants \"error\""));
  EXPECT_THAT(refusal(R"({"fault":"drop","on":"touch","ms":3})"), ::testing::StartsWith("/ms "));
  EXPECT_THAT(refusal(R"({"fault":"loop_cut","times":3})"), ::testing::StartsWith("/times "));
  EXPECT_THAT(refusal(R"({"fault":"loop_cut","touch":3,"phase":"idle"})"), ::testing::StartsWith("/phase "));
}

TEST(FaultNames, AreEachInTheListOfFiles) {
  std::ifstream file(TOUCHCAL_SOURCE_DIR "/config/FILES.md");
  std::stringstream page;
  page << file.rdbuf();
  std::set<std::string> seen;
  for (const std::string& name : fault_names()) {
    EXPECT_NE(page.str().find('`' + name + '`'), std::string::npos) << name;
    EXPECT_TRUE(seen.insert(name).second) << name << " is there twice";
  }
  EXPECT_GT(seen.size(), 40U);
}

TEST(FaultNames, AFaultOfAMessageIsTakenExactlyWhereItFits) {
  const std::map<std::string, Fault> of_messages{
      {"drop", Fault::kDrop},          {"merge", Fault::kMerge},
      {"bad_value", Fault::kBadValue}, {"wrong_session", Fault::kWrongSession},
      {"wrong_arm", Fault::kWrongArm}, {"stale_result", Fault::kStaleResult},
  };
  for (const auto& [name, fault] : of_messages) {
    for (int number = 0; number < 256; ++number) {
      const auto type = static_cast<cs8::MessageType>(number);
      if (cs8::name(type).empty()) continue;
      const std::string line = R"({"fault":")" + name + R"(","on":")" + std::string(cs8::name(type)) + "\"}";
      EXPECT_EQ(refusal(line).empty(), fits(target_of(fault), type)) << line;
    }
  }
}

}  // namespace
}  // namespace sim
