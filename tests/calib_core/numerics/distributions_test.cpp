#include "calib_core/numerics/distributions.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <stdexcept>
#include <vector>

namespace calib {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

void expect_relative(double value, double wanted) {
  EXPECT_NEAR(value / wanted, 1.0, kDistributionErrorMax) << value << " instead of " << wanted;
}

// NIST/SEMATECH e-Handbook of Statistical Methods, 1.3.6.7.4, upper-tail critical values.
TEST(ChiSquare, SurvivalAgreesWithTheTablesOfNist) {
  struct Entry {
    double degrees, tail, critical;
  };
  const std::vector<Entry> table{{1, 0.05, 3.841},     {1, 0.001, 10.828},   {10, 0.10, 15.987},
                                 {10, 0.05, 18.307},   {10, 0.01, 23.209},   {10, 0.001, 29.588},
                                 {100, 0.05, 124.342}, {100, 0.01, 135.807}, {100, 0.001, 149.449}};
  for (const Entry& entry : table) {
    // The table rounds to three decimals.
    EXPECT_GT(chi_square_survival(entry.critical - 0.0005, entry.degrees), entry.tail) << entry.critical;
    EXPECT_LT(chi_square_survival(entry.critical + 0.0005, entry.degrees), entry.tail) << entry.critical;
  }
}

// mpmath 1.3, 50 digits: gammainc(degrees / 2, x / 2, inf, regularized=True).
TEST(ChiSquare, SurvivalIsRightInTheFarTailAndForManyDegrees) {
  expect_relative(chi_square_survival(0.5, 3), 0.91889141165467586);
  expect_relative(chi_square_survival(1e-6, 1), 0.99920211557217787);
  expect_relative(chi_square_survival(141, 1), 1.6089487856773525e-32);
  expect_relative(chi_square_survival(132.79989270501422, 1), 9.9999999999999871e-31);
  expect_relative(chi_square_survival(180, 10), 2.3429885950924864e-33);
  expect_relative(chi_square_survival(401.40327848735303, 125), 1.0000000000000003e-30);
  expect_relative(chi_square_survival(1000, 123), 2.4230942104284362e-137);
  expect_relative(chi_square_survival(9000, 10000), 0.99999999999987302);
  expect_relative(chi_square_survival(10300, 10000), 0.0176381174473454);
  expect_relative(chi_square_survival(11700, 10000), 1.9793209078143383e-30);
  expect_relative(chi_square_survival(100500, 100000), 0.13185481160338378);
}

TEST(ChiSquare, TwoDegreesAreAnExponentialAndTheEndsAreExact) {
  for (const double x : {0.1, 1.0, 10.0, 100.0}) expect_relative(chi_square_survival(x, 2), std::exp(-x / 2));
  EXPECT_EQ(chi_square_survival(0.0, 7), 1.0);
  EXPECT_EQ(chi_square_survival(kInfinity, 7), 0.0);
}

// NIST/SEMATECH e-Handbook of Statistical Methods, 1.3.6.7.2: its one-sided columns 0.975 and 0.995.
TEST(Student, FactorAgreesWithTheTablesOfNist) {
  struct Entry {
    double degrees, confidence, factor;
  };
  const std::vector<Entry> table{{1, 0.95, 12.706},        {2, 0.95, 4.303},        {5, 0.95, 2.571},
                                 {10, 0.95, 2.228},        {30, 0.95, 2.042},       {100, 0.95, 1.984},
                                 {1, 0.99, 63.657},        {10, 0.99, 3.169},       {100, 0.99, 2.626},
                                 {kInfinity, 0.95, 1.960}, {kInfinity, 0.99, 2.576}};
  for (const Entry& entry : table) {
    EXPECT_NEAR(student_two_sided_factor(entry.confidence, entry.degrees), entry.factor, 0.00051)
        << entry.degrees << " degrees, " << entry.confidence;
  }
}

// mpmath 1.3, 50 digits: betainc(v / 2, 1 / 2, 0, v / (v + k^2), regularized=True) bisected for the tail
// 1 - confidence, the confidence taken as the double it is.
TEST(Student, FactorIsRightDownToATailOfOneInAMillionMillion) {
  struct Entry {
    double confidence, degrees, factor;
  };
  const std::vector<Entry> entries{{0.5, 1, 1.0},
                                   {0.5, 5000, 0.674538820360874},
                                   {0.5, 1e7, 0.67448977472957515},
                                   {0.95, 1, 12.706204736174693},
                                   {0.95, 12.5, 2.1691859427125406},
                                   {0.95, 120, 1.9799304050824405},
                                   {0.95, 5000, 1.9604385517065075},
                                   {0.95, 99999, 1.9599877077718444},
                                   {0.999999999, 3, 1301.6371795626481},
                                   {0.999999999, 120, 6.6323942179207719},
                                   {0.999999999999, 1, 636633855803.5593},
                                   {0.999999999999, 2, 1000011.0610428281},
                                   {0.999999999999, 12.5, 28.374319095572239},
                                   {0.999999999999, 120, 7.9765698650184297},
                                   {0.999999999999, 5000, 7.1490345563591035},
                                   {0.999999999999, 100001, 7.1314341741565579}};
  for (const Entry& entry : entries) {
    SCOPED_TRACE(entry.degrees);
    expect_relative(student_two_sided_factor(entry.confidence, entry.degrees), entry.factor);
  }
}

TEST(Student, OneAndTwoDegreesHaveClosedForms) {
  for (const double confidence : {1e-3, 0.1, 0.5, 0.95, 0.999999}) {
    expect_relative(student_two_sided_factor(confidence, 1), std::tan(std::acos(-1.0) / 2 * confidence));
    expect_relative(student_two_sided_factor(confidence, 2),
                    confidence * std::sqrt(2.0 / (1.0 - confidence * confidence)));
  }
}

TEST(Student, FactorHasNoStepWhereTheExpansionTakesOver) {
  for (const double confidence : {0.001, 0.5, 0.95, 0.999999999999}) {
    expect_relative(student_two_sided_factor(confidence, std::nextafter(1e4, 0.0)),
                    student_two_sided_factor(confidence, 1e4));
  }
}

// mpmath 1.3, 50 digits: sqrt(2) erfinv(confidence).
TEST(Normal, FactorIsRightAndTheLimitOfStudents) {
  expect_relative(normal_two_sided_factor(0.5), 0.67448975019608174);
  expect_relative(normal_two_sided_factor(0.95), 1.9599639845400539);
  expect_relative(normal_two_sided_factor(0.999999999), 6.1094102093834491);
  expect_relative(normal_two_sided_factor(0.999999999999), 7.1305098928792724);
  EXPECT_EQ(student_two_sided_factor(0.95, kInfinity), normal_two_sided_factor(0.95));
}

// Exact for two degrees of freedom in the numerator: (1 + 2 x / d)^(-d / 2).
TEST(FisherF, SurvivalIsTheClosedFormForTwoDegreesOfFreedom) {
  for (const double degrees : {1.0, 4.5, 10.0, 200.0}) {
    for (const double x : {0.0, 0.3, 3.0, 40.0})
      expect_relative(f_survival(x, 2.0, degrees), std::pow(1.0 + 2.0 * x / degrees, -0.5 * degrees));
  }
}

TEST(Distributions, WhatIsOutsideTheDomainIsAMistakeOfTheProgram) {
  for (const double confidence : {0.0, 1.0, -0.1, 1.1, kNan}) {
    EXPECT_THROW(normal_two_sided_factor(confidence), std::logic_error) << confidence;
    EXPECT_THROW(student_two_sided_factor(confidence, 5), std::logic_error) << confidence;
  }
  for (const double degrees : {0.0, 0.5, -1.0, kNan}) {
    EXPECT_THROW(student_two_sided_factor(0.95, degrees), std::logic_error) << degrees;
  }
  for (const double degrees : {0.0, -1.0, 2.0 * kChiSquareDegreesMax, kInfinity, kNan}) {
    EXPECT_THROW(chi_square_survival(1.0, degrees), std::logic_error) << degrees;
  }
  EXPECT_THROW(chi_square_survival(-1.0, 5), std::logic_error);
  for (const double degrees : {0.0, -1.0, kInfinity, kNan}) {
    EXPECT_THROW(f_survival(1.0, degrees, 5.0), std::logic_error) << degrees;
    EXPECT_THROW(f_survival(1.0, 5.0, degrees), std::logic_error) << degrees;
  }
  EXPECT_THROW(f_survival(-1.0, 5.0, 5.0), std::logic_error);
  EXPECT_THROW(chi_square_survival(kNan, 5), std::logic_error);
}

TEST(SampleQuantile, IsTheSmallestValueThatTheShareDoesNotExceed) {
  const std::vector<double> values{5.0, 1.0, 4.0, 2.0, 3.0};
  EXPECT_EQ(sample_quantile(values, 1.0), 5.0);
  EXPECT_EQ(sample_quantile(values, 0.95), 5.0);
  EXPECT_EQ(sample_quantile(values, 0.8), 4.0);
  EXPECT_EQ(sample_quantile(values, 0.79), 4.0);
  EXPECT_EQ(sample_quantile(values, 1e-3), 1.0);
  EXPECT_EQ(sample_quantile({7.0}, 0.5), 7.0);
}

TEST(SampleQuantile, OfWhatIsNotANumberIsNotANumberAndOfNothingIsRefused) {
  EXPECT_TRUE(std::isnan(sample_quantile({1.0, kNan, 2.0}, 0.5)));
  EXPECT_THROW(sample_quantile({}, 0.5), std::logic_error);
  EXPECT_THROW(sample_quantile({1.0}, 0.0), std::logic_error);
  EXPECT_THROW(sample_quantile({1.0}, 1.1), std::logic_error);
}

// A chi-square variable of one degree is the square of a normal one: P(|z + 2| > 1.959964) by tables.
TEST(Power, IsThatOfTheShiftedNormalForOneDegree) {
  EXPECT_NEAR(chi_square_power(0.05, 1.0, 4.0), 0.516005, 1e-6);
  EXPECT_NEAR(f_power(0.05, 1.0, 1e7, 4.0), 0.516005, 1e-5);
}

TEST(Power, IsTheLevelWhereNothingIsAddedAndGrowsWithIt) {
  EXPECT_NEAR(f_power(0.001, 60.0, 9.0, 1e-9), 0.001, 1e-6);
  EXPECT_EQ(chi_square_power(0.001, 60.0, 0.0), 0.001);
  EXPECT_LT(f_power(0.001, 60.0, 9.0, 20.0), f_power(0.001, 60.0, 9.0, 200.0));
  EXPECT_LT(f_power(0.001, 60.0, 9.0, 20.0), f_power(0.001, 60.0, 90.0, 20.0));
  EXPECT_THROW(f_power(0.0, 60.0, 9.0, 20.0), std::logic_error);
  EXPECT_THROW(chi_square_power(0.05, 60.0, -1.0), std::logic_error);
}

}  // namespace
}  // namespace calib
