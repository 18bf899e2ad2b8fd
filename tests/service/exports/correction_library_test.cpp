#include "service/exports/correction_library.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <pugixml.hpp>
#include <stdexcept>

#include "tests/service/exports/exported_arms.hpp"

// What the numbers do on a controller: tests/val3/abs_library_test.
namespace cell {
namespace {

using ::testing::HasSubstr;

CorrectionLibrary library_of(const Arm& arm) {
  const Arm nominal = shipped_arm("tx90");
  return {.arms = {.nominal = nominal.model,
                   .calibrated = rigid(arm).model,
                   .joint_ranges = nominal.joint_ranges,
                   .covariance = {}},
          .wrist_to_flange_m = 0.1,
          .serial = "A1",
          .model = "abc",
          .warmth = "cold",
          .valid_until = 20270131};
}

/// The attribute `name` of element `key` of a variable.
std::string stored(const std::string& file, const char* variable, int key, const char* name) {
  pugi::xml_document document;
  EXPECT_TRUE(document.load_string(file.c_str()));
  const pugi::xml_node data =
      document.child("Database").child("Datas").find_child_by_attribute("Data", "name", variable);
  return data.find_child_by_attribute("Value", "key", std::to_string(key).c_str())
      .attribute(name)
      .as_string();
}

std::string why_not(const CorrectionLibrary& library) {
  try {
    static_cast<void>(correction_library_data(library));
  } catch (const std::invalid_argument& refused) {
    return refused.what();
  }
  return "";
}

TEST(CorrectionLibrary, SaysWhoseNumbersTheyAre) {
  const std::string file = correction_library_data(library_of(calibrated(shipped_arm("tx90"))));
  EXPECT_EQ(stored(file, "kSerial", 0, "value"), "A1");
  EXPECT_EQ(stored(file, "kModel", 0, "value"), "abc");
  EXPECT_EQ(stored(file, "kWarmth", 0, "value"), "cold");
  EXPECT_EQ(stored(file, "kUntil", 0, "value"), "20270131");
}

TEST(CorrectionLibrary, NeverHasTheArmsPlaceNorTheTurnOfJoint6) {
  const Arm nominal = shipped_arm("tx90");
  const std::string file = correction_library_data(library_of(calibrated(nominal)));
  for (const char* name : {"x", "y", "z", "rx", "ry", "rz"}) EXPECT_EQ(stored(file, "kFixed", 0, name), "0");
  EXPECT_EQ(stored(file, "kAlong", 0, "value"), "0");
  EXPECT_EQ(stored(file, "kOffset", 0, "value"), "0");
  EXPECT_NE(stored(file, "kOffset", 1, "value"),
            stored(correction_library_data(library_of(nominal)), "kOffset", 1, "value"));
  EXPECT_EQ(stored(file, "kOffset", 5, "value"),
            stored(correction_library_data(library_of(nominal)), "kOffset", 5, "value"));
}

TEST(CorrectionLibrary, AddsWhatTheFlangeCarriesToTheWrist) {
  Arm arm = shipped_arm("tx90");
  arm.model.links.back() = {.r_m = 0.3};
  arm.model.masses[6] = {2.0, {0.0, 0.0, 0.05}};
  arm.model.masses[7] = {6.0, {0.01, 0.0, -0.1}};
  const std::string file = correction_library_data(library_of(arm));
  EXPECT_EQ(stored(file, "kMass", 5, "value"), "8");
  EXPECT_EQ(stored(file, "kCentre", 5, "x"), "7.5");
  EXPECT_EQ(stored(file, "kCentre", 5, "z"), "162.5");
}

TEST(CorrectionLibrary, RefusesWhatItCannotCarryAndSaysWhy) {
  const CorrectionLibrary right = library_of(shipped_arm("tx90"));
  EXPECT_EQ(why_not(right), "");
  CorrectionLibrary wrong = right;
  wrong.serial.clear();
  EXPECT_THAT(why_not(wrong), HasSubstr("/arm_serial"));
  wrong = right;
  wrong.serial = "a\"b";
  EXPECT_THAT(why_not(wrong), HasSubstr("the serial number"));
  wrong = right;
  wrong.warmth = std::string(61, 'w');
  EXPECT_THAT(why_not(wrong), HasSubstr("the warmth"));
  wrong = right;
  wrong.arms.calibrated.ripples_rad[3].sin = 1e-6;
  EXPECT_THAT(why_not(wrong), HasSubstr("waves of its gears"));
  wrong = right;
  wrong.arms.calibrated.joint_types[2] = calib::JointType::kPrismatic;
  EXPECT_THAT(why_not(wrong), HasSubstr("slides"));
  wrong = right;
  wrong.arms.nominal.links[3].theta_rad += 0.1;
  EXPECT_THAT(why_not(wrong), HasSubstr("joints 3 and 5"));
}

}  // namespace
}  // namespace cell
