#include "config/fault_file.hpp"

#include <gtest/gtest.h>

#include <random>

#include "config/config_error.hpp"
#include "folder.hpp"

namespace cell {
namespace {

class FaultFileTest : public ::testing::Test {
 protected:
  FaultFile read(const std::string& text) { return read_faults(folder_.write("faults.json", text)); }

  /// Where the file is refused.
  std::string refused_at(const std::string& text) {
    try {
      read(text);
    } catch (const ConfigError& error) {
      EXPECT_NE(error.source().find("faults.json"), std::string::npos);
      return error.pointer();
    }
    return "taken";
  }
  std::string fault_refused_at(const std::string& fault) {
    return refused_at(R"({"schema":"touchcal/faults/1","faults":[{"fault":"drop"},)" + fault + "]}");
  }

  Folder folder_;
};

TEST_F(FaultFileTest, ReadsWhatWasWrittenAndLeavesTheRestOpen) {
  const FaultFile file = read(R"({"schema":"touchcal/faults/1","operator":{"confirms":false},"faults":[
    {"fault":"close","on":"touch_result","count":3},
    {"fault":"delay","on":"accepted","count":"every","ms":100},
    {"fault":"probe_stuck","touch":5,"phase":"retract","after_ms":2.5},
    {"fault":"task_dies","error":150}]})");
  EXPECT_FALSE(file.duties.confirms);
  EXPECT_TRUE(file.duties.powers_up && file.duties.touches_probe && file.duties.frees_arm);
  ASSERT_EQ(file.faults.size(), 4U);
  EXPECT_EQ(file.faults[0].fault, "close");
  EXPECT_EQ(file.faults[0].on, "touch_result");
  EXPECT_EQ(file.faults[0].count->nth, 3);
  EXPECT_FALSE(file.faults[0].touch || file.faults[0].duration_s || file.faults[0].after_s);
  EXPECT_TRUE(file.faults[1].count->every);
  EXPECT_DOUBLE_EQ(file.faults[1].duration_s.value(), 0.1);
  EXPECT_EQ(file.faults[2].touch->nth, 5);
  EXPECT_EQ(file.faults[2].phase, "retract");
  EXPECT_DOUBLE_EQ(file.faults[2].after_s.value(), 0.0025);
  EXPECT_EQ(file.faults[2].pointer, "/faults/2");
  EXPECT_EQ(file.faults[3].error, 150);
}

TEST_F(FaultFileTest, AFileMayHaveNeitherFaultsNorOperator) {
  const FaultFile file = read(R"({"schema":"touchcal/faults/1"})");
  EXPECT_TRUE(file.faults.empty());
  EXPECT_TRUE(file.duties.confirms);
}

TEST_F(FaultFileTest, WhatIsWrongIsRefusedWithItsPlace) {
  EXPECT_EQ(refused_at(R"({"schema":"touchcal/faults/9"})"), "/schema");
  EXPECT_EQ(refused_at(R"({"schema":"touchcal/faults/1","fault":[]})"), "/fault");
  EXPECT_EQ(refused_at(R"({"schema":"touchcal/faults/1","operator":{"confirms":1}})"), "/operator/confirms");
  EXPECT_EQ(refused_at(R"({"schema":"touchcal/faults/1","operator":{"sings":true}})"), "/operator/sings");
  EXPECT_EQ(fault_refused_at(R"({"on":"touch"})"), "/faults/1");
  EXPECT_EQ(fault_refused_at(R"({"fault":3})"), "/faults/1/fault");
  EXPECT_EQ(fault_refused_at(R"({"fault":"drop","at":"touch"})"), "/faults/1/at");
  EXPECT_EQ(fault_refused_at(R"({"fault":"drop","on":"touch","count":0})"), "/faults/1/count");
  EXPECT_EQ(fault_refused_at(R"({"fault":"drop","on":"touch","count":1.5})"), "/faults/1/count");
  EXPECT_EQ(fault_refused_at(R"({"fault":"drop","on":"touch","count":"always"})"), "/faults/1/count");
  EXPECT_EQ(fault_refused_at(R"({"fault":"drop","count":2})"), "/faults/1/count");
  EXPECT_EQ(fault_refused_at(R"({"fault":"drop","on":"touch","touch":2})"), "/faults/1/touch");
  EXPECT_EQ(fault_refused_at(R"({"fault":"drop","on":"touch","phase":"search"})"), "/faults/1/phase");
  EXPECT_EQ(fault_refused_at(R"({"fault":"delay","on":"touch","ms":-1})"), "/faults/1/ms");
  EXPECT_EQ(fault_refused_at(R"({"fault":"delay","on":"touch","ms":1e12})"), "/faults/1/ms");
  EXPECT_EQ(fault_refused_at(R"({"fault":"close","after_ms":"soon"})"), "/faults/1/after_ms");
  EXPECT_EQ(fault_refused_at(R"({"fault":"monitor_speed","percent":101})"), "/faults/1/percent");
  EXPECT_EQ(fault_refused_at(R"({"fault":"probe_bounces","times":1000000})"), "/faults/1/times");
  EXPECT_EQ(fault_refused_at(R"({"fault":"task_dies","error":0})"), "/faults/1/error");
  std::string many = R"({"schema":"touchcal/faults/1","faults":[{"fault":"drop"})";
  for (std::size_t i = 0; i < kDeclaredFaultsMax; ++i) many += R"(,{"fault":"drop"})";
  EXPECT_EQ(refused_at(many + "]}"), "/faults");
}

TEST(ControlLine, IsAFaultAWordToTheOperatorOrAQuestion) {
  const ControlRequest fault = parse_control_line(R"({"fault":"close"})");
  EXPECT_EQ(std::get<DeclaredFault>(fault).fault, "close");
  const ControlRequest change = parse_control_line(R"({"operator":{"frees_arm":false}})");
  const OperatorDuties before{.confirms = false};
  const OperatorDuties after = changed(before, std::get<OperatorChange>(change));
  EXPECT_FALSE(after.frees_arm || after.confirms);
  EXPECT_TRUE(after.powers_up && after.touches_probe);
  EXPECT_TRUE(std::holds_alternative<ShowState>(parse_control_line(R"({"show":"state"})")));
  EXPECT_EQ(std::get<BlockOrder>(parse_control_line(R"({"block":"stand"})")).place, "stand");
}

TEST(ControlLine, AnythingElseIsRefused) {
  for (const char* line : {"", "close", "[]", "{}", "3", R"({"show":"all"})",
                           R"({"show":"state","fault":"close"})", R"({"operator":true})", R"({"block":3})",
                           R"({"block":"stand","show":"state"})", "{\"fault\":\"\xff\"}"}) {
    EXPECT_THROW(parse_control_line(line), ConfigError) << line;
  }
  EXPECT_THROW(parse_control_line(std::string(kControlLineMax + 1, ' ') + "{}"), ConfigError);
  std::mt19937 chance(7);
  for (int i = 0; i < 2000; ++i) {
    std::string bytes(chance() % 40, '{');
    for (char& byte : bytes) {
      if (chance() % 4 != 0) byte = static_cast<char>(chance());
    }
    EXPECT_THROW(parse_control_line(bytes), ConfigError);
  }
}

TEST(ControlLine, AnswersAreOneLineWhateverTheyTell) {
  EXPECT_EQ(control_answer(), R"({"ok":true})");
  EXPECT_EQ(control_answer({{"powered", true}, {"mode", std::string("remote")}}),
            R"({"ok":true,"state":{"mode":"remote","powered":true}})");
  const std::string refusal = control_refusal("line\nbreak, \"quotes\" and \xff");
  EXPECT_EQ(refusal.find('\n'), std::string::npos);
  EXPECT_NE(refusal.find(R"("ok":false)"), std::string::npos);
}

}  // namespace
}  // namespace cell
