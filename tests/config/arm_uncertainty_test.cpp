#include "config/arm_uncertainty.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

#include "config/config_error.hpp"
#include "config/json_value.hpp"

namespace cell {
namespace {

using nlohmann::json;
using testing::HasSubstr;

int arm_index(const char* name) { return calib::error_parameter_index(name).value(); }

/// d3 and r4 that almost cancel each other, and a compliance.
calib::ArmCovariance of_three_errors() {
  calib::ArmCovariance covariance = calib::no_covariance();
  const int d3 = arm_index("d3"), r4 = arm_index("r4");
  const int compliance = calib::nongeometric_index(calib::compliance_position(1));
  covariance(d3, d3) = covariance(r4, r4) = 1e-8 / 3.0;
  covariance(d3, r4) = covariance(r4, d3) = -0.99 * 1e-8 / 3.0;
  covariance(compliance, compliance) = 1.5e-13;
  covariance(compliance, d3) = covariance(d3, compliance) = 1e-12;
  return covariance;
}

calib::ArmCovariance read_text(const std::string& text) {
  const json document = json::parse(text);
  return arm_covariance_from_json(JsonValue("arm.json", document));
}

TEST(ArmUncertainty, IsReadAsItWasWrittenToNineDigits) {
  const calib::ArmCovariance written = of_three_errors();
  const calib::ArmCovariance read = read_text(arm_covariance_text(written));
  for (Eigen::Index row = 0; row < written.rows(); ++row) {
    for (Eigen::Index column = 0; column < written.cols(); ++column)
      EXPECT_NEAR(read(row, column), written(row, column), 5e-9 * std::abs(written(row, column)));
  }
  EXPECT_EQ(arm_covariance_text(read), arm_covariance_text(written));
}

TEST(ArmUncertainty, OfACertainArmIsReadAsWell) {
  EXPECT_TRUE(read_text(arm_covariance_text(calib::no_covariance())).isZero(0.0));
}

TEST(ArmUncertainty, NamesOnlyWhatIsNotCertain) {
  const json document = json::parse(arm_covariance_text(of_three_errors()));
  EXPECT_EQ(document.at("errors"), json({"d3", "r4", "compliance2"}));
  EXPECT_EQ(document.at("covariance_si").size(), 3U);
  EXPECT_EQ(document.at("covariance_si").at(2).size(), 3U);
}

struct SpoiledUncertainty {
  const char* patch;  // a JSON patch
  const char* pointer;
  const char* said;
};

class SpoiledArmUncertainty : public testing::TestWithParam<SpoiledUncertainty> {};

TEST_P(SpoiledArmUncertainty, IsRefusedAtItsPlace) {
  const json document =
      json::parse(arm_covariance_text(of_three_errors())).patch(json::parse(GetParam().patch));
  try {
    arm_covariance_from_json(JsonValue("arm.json", document));
    FAIL() << "was read";
  } catch (const ConfigError& error) {
    EXPECT_EQ(error.pointer(), GetParam().pointer);
    EXPECT_THAT(error.message(), HasSubstr(GetParam().said));
    EXPECT_THAT(error.message(), HasSubstr(";"));
  }
}

INSTANTIATE_TEST_SUITE_P(
    Entries, SpoiledArmUncertainty,
    testing::Values(
        SpoiledUncertainty{R"([{"op":"replace","path":"/errors/1","value":"d9"}])", "/errors/1",
                           "is \"d9\", which no arm has"},
        SpoiledUncertainty{R"([{"op":"replace","path":"/errors/1","value":"d3"}])", "/errors/1", "each once"},
        SpoiledUncertainty{R"([{"op":"replace","path":"/errors/0","value":"r5"}])", "/errors/1",
                           "stands after \"r5\""},
        SpoiledUncertainty{R"([{"op":"remove","path":"/errors/2"}])", "/covariance_si", "wants 2 entries"},
        SpoiledUncertainty{R"([{"op":"replace","path":"/errors","value":[]}])", "/covariance_si",
                           "wants 0 entries"},
        SpoiledUncertainty{R"([{"op":"remove","path":"/covariance_si/1/0"}])", "/covariance_si/1",
                           "wants 2 entries"},
        SpoiledUncertainty{R"([{"op":"replace","path":"/covariance_si/0/0","value":-1e-9}])",
                           "/covariance_si/0/0", "is -1e-09; give"},
        SpoiledUncertainty{R"([{"op":"replace","path":"/covariance_si/0/0","value":1e13}])",
                           "/covariance_si/0/0", "give"},
        SpoiledUncertainty{R"([{"op":"replace","path":"/covariance_si/1/0","value":null}])",
                           "/covariance_si/1/0", "is null"},
        SpoiledUncertainty{R"([{"op":"replace","path":"/covariance_si/1/0","value":-4e-9}])",
                           "/covariance_si", "is no covariance"},
        SpoiledUncertainty{R"([{"op":"replace","path":"/covariance_si/0/0","value":0}])",
                           "/covariance_si/0/0", "is 0; give"},
        SpoiledUncertainty{R"([{"op":"add","path":"/k","value":2}])", "/k", "unknown key"}));

TEST(ArmUncertainty, ThatIsNoNumberIsAMistakeOfOurOwn) {
  calib::ArmCovariance covariance = of_three_errors();
  covariance(arm_index("d3"), arm_index("d3")) = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(arm_covariance_text(covariance), std::logic_error);
}

}  // namespace
}  // namespace cell
