// Examples of manual 6, pages 34 to 47.
#include "tests/sim_controller/val3/machine/evaluated.hpp"

namespace val3 {
namespace {

TEST(Numbers, AreAsTheManualsExamples) {
  expect_values({{"abs(-45)", 45},
                 {"sqrt(9)", 3},
                 {"exp(1)", 2.718281828459045},
                 {"power(5,2)", 25},
                 {"power(-3,2)", 9},
                 {"ln(2.718281828459045)", 1},
                 {"log(1000)", 3},
                 {"roundUp(7.8)", 8},
                 {"roundUp(-7.8)", -7},
                 {"roundDown(7.8)", 7},
                 {"roundDown(-7.8)", -8},
                 {"round(7.8)", 8},
                 {"round(-7.8)", -8},
                 {"min(-1,10)", -1},
                 {"max(-1,10)", 10},
                 {"limit(30,-90,90)", 30},
                 {"limit(100,90,-90)", -90},
                 {"limit(-100,-90,90)", -90},
                 {"sel(true,1,2)", 1},
                 {"sel(1>2,1,2)", 2},
                 {"7%4", 3},
                 {"-7%4", -3},
                 {"8/2*4", 16},
                 {"5-3+1", 3}});
}

TEST(Numbers, AnglesAreDegrees) {
  expect_values({{"sin(30)", 0.5},
                 {"cos(60)", 0.5},
                 {"tan(45)", 1},
                 {"asin(0.5)", 30},
                 {"acos(0.5)", 60},
                 {"atan(1)", 45}});
  EXPECT_NE(evaluated("cos(90)").number, 0.0) << "a num is a double: manual 6, page 34";
}

TEST(Numbers, WhatHasNoValueIsAnError) {
  expect_errors({{"sqrt(-1)", kErrorArgument},
                 {"ln(0)", kErrorArgument},
                 {"log(-1)", kErrorArgument},
                 {"asin(2)", kErrorArgument},
                 {"acos(-2)", kErrorArgument},
                 {"exp(1000)", kErrorArgument},
                 {"power(-2,0.5)", kErrorArgument},
                 {"1/0", kErrorDivision},
                 {"1%0", kErrorDivision},
                 {"bAnd(4294967296,1)", kErrorArgument},
                 {"bNot(-1)", kErrorArgument}});
}

TEST(Numbers, BitsAreOf32) {
  expect_values({{"bAnd(12,10)", 8},
                 {"bOr(12,10)", 14},
                 {"bXor(12,10)", 6},
                 {"bNot(0)", 4294967295.0},
                 {"bNot(4294967295)", 0}});
}

TEST(Numbers, StandInBytesByTheirFormatAndComeBack) {
  const std::vector<std::pair<std::string, std::vector<int>>> formats{{"-1", {254}},
                                                                      {"1", {200}},
                                                                      {"-2l", {254, 255}},
                                                                      {"2b", {1, 44}},
                                                                      {"-4l", {254, 255, 255, 255}},
                                                                      {"4b", {0, 0, 1, 44}},
                                                                      {"4.0l", {0, 0, 192, 191}},
                                                                      {"8.0b", {191, 248, 0, 0, 0, 0, 0, 0}}};
  for (const auto& [format, bytes] : formats) {
    const double value = format == "1"                            ? 200
                         : format.find(".0") != std::string::npos ? -1.5
                         : format[0] == '-'                       ? -2
                                                                  : 300;
    SmallProject project;
    with_variables(project).program("start", "n[0]=" + std::to_string(value) + "\nn[1]=toBinary(n[0],1,\"" +
                                                 format + "\",n[2])\nn[10]=fromBinary(n[2],n[1],\"" + format +
                                                 "\",n[11])");
    Running run(project);
    run.ticks(2);
    ASSERT_EQ(run.number("n", 1), static_cast<double>(bytes.size())) << format << run.log();
    for (std::size_t i = 0; i < bytes.size(); ++i)
      EXPECT_EQ(run.number("n", 2 + i), bytes[i]) << format << ' ' << i;
    EXPECT_EQ(run.number("n", 10), 1) << format;
    EXPECT_EQ(run.number("n", 11), value) << format;
  }
}

TEST(Numbers, BytesThatAreNoneEndTheirReading) {
  SmallProject project;
  with_variables(project).program("start", "n[0]=1\nn[2]=300\nn[10]=fromBinary(n,4,\"2l\",n[11])");
  Running run(project);
  run.ticks(2);
  EXPECT_EQ(run.number("n", 10), -1) << "one was read before";
  expect_errors({{"toBinary(n,1,\"3l\",n[4])", kErrorParameter},
                 {"toBinary(n,21,\"1\",n)", kErrorParameter},
                 {"toBinary(n,1,\"8.0l\",n[13])", kErrorParameter},
                 {"toBinary(n,1,\"1b\",n)", kErrorParameter}});
}

TEST(Numbers, ThatAreTooLargeAreAnError) {
  expect_errors({{"n[1]*n[1]", kErrorArgument},
                 {"n[1]/0.00000001", kErrorArgument},
                 {"n[1]+n[1]", kErrorArgument},
                 {"-n[1]-n[1]", kErrorArgument}},
                "n[1]=power(10,308)*1.5");
}

}  // namespace
}  // namespace val3
