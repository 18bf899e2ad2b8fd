#include "config/true_tips.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "copied_config.hpp"
#include "probe_with_star.hpp"

namespace cell {
namespace {

using nlohmann::json;
using testing::HasSubstr;

/// The demo cell whose probe has two further tips.
class TrueTips : public CopiedConfig {
 protected:
  TrueTips() {
    edit(kProbe, [](json& probe) {
      add_tips(probe,
               {star_tip("left", {40, 0, -20}, {1, 0, 0}), star_tip("back", {0, -40, -20}, {0, -1, 0})});
    });
  }
  [[nodiscard]] Truth truth_with(const json& tips) const {
    edit(kRealTruth, [&](json& document) {
      document["schema"] = "touchcal/truth/4";
      document["tips"] = tips;
    });
    return read_truth(path(kRealTruth));
  }
  [[nodiscard]] std::vector<ProbeTip> tips_with(const json& tips) const {
    return true_tips(truth_with(tips), read().probe);
  }
  [[nodiscard]] ConfigError error_with(const json& tips) const {
    return error_of([&] { static_cast<void>(tips_with(tips)); });
  }
};

TEST_F(TrueTips, AreThoseOfTheFileWhereTheTruthSaysNothing) {
  const std::vector<ProbeTip> tips = true_tips({}, read().probe);
  ASSERT_EQ(tips.size(), 2U);
  EXPECT_EQ(tips[1].center_m, read().probe.tips[1].center_m);
  EXPECT_EQ(tips[1].radius_m, read().probe.tips[1].radius_m);
  EXPECT_TRUE(true_tips({}, {}).empty());
}

TEST_F(TrueTips, AreShiftedAlongTheAxesOfFrame7AndHaveTheirOwnRadius) {
  const auto tips = tips_with({{"left", {{"shift_mm", {0.3, -0.1, 0.2}}, {"radius_mm", 1.998}}}});
  EXPECT_TRUE(tips[0].center_m.isApprox(Eigen::Vector3d(0.0403, -0.0001, -0.0198), 1e-12));
  EXPECT_DOUBLE_EQ(tips[0].radius_m, 1.998e-3);
  EXPECT_TRUE(tips[1].center_m.isApprox(Eigen::Vector3d(0.0, -0.04, -0.02), 1e-12));
  EXPECT_DOUBLE_EQ(tips[1].radius_m, 2e-3);
}

TEST_F(TrueTips, CanBeSwitchedOffWithTheirValuesKept) {
  const json left{{"shift_mm", {0.3, 0, 0}}};
  EXPECT_EQ(truth_with({{"left", left}, {"on", true}}).tips.size(), 1U);
  EXPECT_TRUE(truth_with({{"left", left}, {"on", false}}).tips.empty());
  EXPECT_EQ(error_with({{"left", {{"shift_mm", {6, 0, 0}}}}, {"on", false}}).pointer(),
            "/tips/left/shift_mm");
}

TEST_F(TrueTips, ThatAreFarOffOrOfNoProbeOrOfAnOlderFileAreRefused) {
  EXPECT_THAT(error_with({{"left", {{"shift_mm", {0, 4, 4}}}}}).message(), HasSubstr("over 5 mm"));
  EXPECT_EQ(error_with({{"left", {{"radius_mm", 0}}}}).pointer(), "/tips/left/radius_mm");
  EXPECT_EQ(error_with({{"left", {{"turn_rad", {0, 0, 0}}}}}).pointer(), "/tips/left/turn_rad");
  EXPECT_EQ(error_with({{"on", 1}}).pointer(), "/tips/on");

  const ConfigError unknown = error_with({{"up", {{"shift_mm", {1, 0, 0}}}}});
  EXPECT_EQ(unknown.pointer(), "/tips/up");
  EXPECT_THAT(unknown.message(), HasSubstr("give one of \"left\", \"back\""));
  EXPECT_EQ(unknown.source(), path(kRealTruth).string());
  edit(kProbe, [](json& document) { document.erase("tips"); });
  EXPECT_THAT(error_with({{"up", {{"shift_mm", {1, 0, 0}}}}}).message(), HasSubstr("leave \"tips\" out"));

  edit(kRealTruth, [](json& document) { document["schema"] = "touchcal/truth/3"; });
  const ConfigError old = error_of([&] { static_cast<void>(read_truth(path(kRealTruth))); });
  EXPECT_EQ(old.pointer(), "/tips");
  EXPECT_THAT(old.message(), HasSubstr("raise \"schema\" to 4"));
}

}  // namespace
}  // namespace cell
