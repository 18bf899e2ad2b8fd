// What config/repeat_reader and the times of touchcal/touches/3 add to the second version.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "calib_core/geometry/units.hpp"
#include "config/read_config.hpp"
#include "config/touches_file.hpp"
#include "folder.hpp"

namespace cell {
namespace {

using nlohmann::json;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

const Cell& cell_of_touches() {
  static const Cell cell = read_cell(kSourceDir / "config/cells/edf/cell.json");
  return cell;
}

/// A touch of the cell in degrees, with so much added to joint 2.
json joints_deg(double added_deg = 0.0) {
  static const TouchesFile made =
      read_touches(kSourceDir / "tests/data/table3-exact.touches.json", cell_of_touches());
  json joints = json::array();
  for (const double joint : made.touches.front().joints) joints.push_back(calib::degrees_from_radians(joint));
  joints[1] = joints[1].get<double>() + added_deg;
  return joints;
}

int plane() {
  static const TouchesFile made =
      read_touches(kSourceDir / "tests/data/table3-exact.touches.json", cell_of_touches());
  return made.touches.front().face + 1;
}

json touch(const json& more = json::object()) {
  json one{{"plane", plane()}, {"joints_deg", joints_deg()}};
  one.update(more);
  return one;
}

json document(const std::vector<json>& touches, const std::vector<json>& references = {}) {
  json all{{"schema", kTouchesSchema}, {"arm", "tx90"}, {"touches", touches}};
  if (!references.empty()) all["reference_touches"] = references;
  return all;
}

TouchesFile read(const json& document) {
  return touches_from_json("body", document.dump(), kTouchesSizeMax, cell_of_touches());
}

ConfigError refusal(const json& document) {
  return error_of([&] { read(document); });
}

TEST(TouchRepeats, AreReadInTheOrderOfTheTouches) {
  const TouchesFile file =
      read(document({touch({{"at_s", 0.0}, {"first_joints_deg", joints_deg(1e-3)}}), touch(),
                     touch({{"at_s", 8.25}, {"again_joints_deg", joints_deg(-1e-3)}})}));
  ASSERT_EQ(file.repeats.two_speed.size(), 1U);
  ASSERT_EQ(file.repeats.touched_again.size(), 1U);
  const calib::ContactPair &contacts = file.repeats.two_speed[0], &again = file.repeats.touched_again[0];
  EXPECT_EQ(contacts.face + 1, plane());
  EXPECT_EQ(contacts.second, file.touches[0].joints);
  EXPECT_NEAR(contacts.first[1] - contacts.second[1], calib::radians_from_degrees(1e-3), 1e-12);
  EXPECT_EQ(again.first, file.touches[2].joints);
  EXPECT_NEAR(again.second[1] - again.first[1], calib::radians_from_degrees(-1e-3), 1e-12);
}

TEST(TouchRepeats, OfATouchWithANoiseOfItsOwnSayNothingOfTheOthers) {
  const json more{{"noise_um", 60.0}, {"first_joints_deg", joints_deg()}, {"again_joints_deg", joints_deg()}};
  const TouchesFile file = read(document({touch(more)}));
  EXPECT_THAT(file.repeats.two_speed, IsEmpty());
  EXPECT_THAT(file.repeats.touched_again, IsEmpty());
}

TEST(TouchRepeats, TheTimesOfReferenceTouchesCountWhereAllHaveOne) {
  const json early = touch({{"at_s", 1.5}}), late = touch({{"at_s", 80.0}});
  EXPECT_EQ(read(document({}, {early, early, late})).repeats.reference_times_s,
            (std::vector{1.5, 1.5, 80.0}));
  EXPECT_THAT(read(document({}, {early, touch(), late})).repeats.reference_times_s, IsEmpty());
  EXPECT_THAT(read(document({}, {touch(), touch()})).repeats.reference_times_s, IsEmpty());
}

TEST(TouchRepeats, AFirstContactOfAnotherPlaceOrPostureIsRefusedWithItsPointer) {
  const auto refused = [](double added_deg) {
    return refusal(document({touch(), touch({{"first_joints_deg", joints_deg(added_deg)}})}));
  };
  const ConfigError far = refused(0.4);  // some 5 mm
  EXPECT_EQ(far.pointer(), "/touches/1/first_joints_deg");
  EXPECT_THAT(far.message(), AllOf(HasSubstr("mm from the second contact of this touch"),
                                   HasSubstr("farther than 1 mm; give joints of the same place")));
  const ConfigError turned = refused(2.5);
  EXPECT_EQ(turned.pointer(), "/touches/1/first_joints_deg");
  EXPECT_THAT(turned.message(), HasSubstr("joint 2 2.5 deg from the second contact of this touch"));
}

TEST(TouchRepeats, ARepetitionMayBeMillimetresAsideAndNoMore) {
  const auto repeated = [](double added_deg) {
    return document({touch({{"again_joints_deg", joints_deg(added_deg)}})});
  };
  EXPECT_EQ(read(repeated(0.1)).repeats.touched_again.size(), 1U);
  const ConfigError far = refusal(repeated(1.2));
  EXPECT_EQ(far.pointer(), "/touches/0/again_joints_deg");
  EXPECT_THAT(far.message(), HasSubstr("mm from the touch that it repeats"));
}

TEST(TouchRepeats, AFirstContactWithoutTheSecondIsRefused) {
  for (const char* key : {"first_joints_deg", "again_joints_deg"}) {
    json alone = touch({{key, joints_deg()}});
    alone.erase("joints_deg");
    const ConfigError error = refusal(document({alone}));
    EXPECT_EQ(error.pointer(), std::string("/touches/0/") + key);
    EXPECT_THAT(error.message(), HasSubstr("in \"joints_deg\", or remove the touch"));
  }
}

TEST(TouchRepeats, TimesThatRunBackwardsAreRefused) {
  const ConfigError error = refusal(document({}, {touch({{"at_s", 9.0}}), touch(), touch({{"at_s", 8.5}})}));
  EXPECT_EQ(error.pointer(), "/reference_touches/2/at_s");
  EXPECT_THAT(
      error.message(),
      HasSubstr("is 8.5 but an earlier reference touch was made at 9; give the reference touches in"));
  EXPECT_EQ(refusal(document({touch({{"at_s", -1.0}})})).pointer(), "/touches/0/at_s");
  EXPECT_EQ(refusal(document({touch({{"at_s", "noon"}})})).pointer(), "/touches/0/at_s");
}

TEST(TouchRepeats, AreOfTheThirdVersion) {
  for (const auto& [schema, version] : {std::pair{kFirstTouchesSchema, "1"}, {kSecondTouchesSchema, "2"}}) {
    for (const json& more : {json{{"at_s", 1.0}}, json{{"first_joints_deg", joints_deg()}},
                             json{{"again_joints_deg", joints_deg()}}}) {
      json earlier = document({touch(more)});
      earlier["schema"] = schema;
      EXPECT_THAT(refusal(earlier).message(), HasSubstr(std::string("in a touches document of version ") +
                                                        version + "; raise \"schema\" to 3"));
    }
    json earlier = document({}, {touch({{"at_s", 1.0}})});
    earlier["schema"] = schema;
    EXPECT_EQ(refusal(earlier).pointer(), "/reference_touches/0/at_s");
  }
}

TEST(TouchRepeats, OfAQualificationAreOfTheFourthVersionAndBounded) {
  json all = document({touch()});
  EXPECT_FALSE(read(all).repeats.qualified);
  all["qualification"] = {{"scatter_um", 12.5}, {"degrees_of_freedom", 9}};
  const auto noise = read(all).repeats.qualified.value();
  EXPECT_DOUBLE_EQ(noise.std_m, 12.5e-6);
  EXPECT_EQ(noise.degrees_of_freedom, 9.0);
  for (const auto& [key, wrong] :
       {std::pair{"scatter_um", 0.0}, {"scatter_um", 1e6}, {"degrees_of_freedom", 0.0}}) {
    json spoiled = all;
    spoiled["qualification"][key] = wrong;
    EXPECT_EQ(refusal(spoiled).pointer(), std::string("/qualification/") + key);
  }
  all["schema"] = kThirdTouchesSchema;
  EXPECT_EQ(refusal(all).pointer(), "/qualification");
}

}  // namespace
}  // namespace cell
