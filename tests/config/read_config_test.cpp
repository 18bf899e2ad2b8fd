#include "config/read_config.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "calib_core/geometry/units.hpp"
#include "calib_core/motion/motion_time.hpp"
#include "config/truth.hpp"
#include "copied_config.hpp"

namespace cell {
namespace {

using nlohmann::json;
using testing::EndsWith;
using testing::HasSubstr;

using ReadConfig = CopiedConfig;

/// `value` put at `at` (nothing: what is there is taken away) must be refused at `pointer` with `said`.
struct Spoiled {
  const char* file;
  const char* at;
  std::optional<json> value;
  const char* pointer;
  const char* said;
};

void PrintTo(const Spoiled& spoiled, std::ostream* stream) {
  *stream << spoiled.file << spoiled.at << " = " << spoiled.value.value_or("nothing");
}

class SpoiledEntry : public ReadConfig, public testing::WithParamInterface<Spoiled> {
 protected:
  static void spoil(json& document, const Spoiled& spoiled) {
    const json::json_pointer place(spoiled.at);
    if (spoiled.value) {
      document[place] = *spoiled.value;
    } else {
      json& parent = document.at(place.parent_pointer());
      parent.is_array() ? parent.erase(std::stoul(place.back()))
                        : static_cast<void>(parent.erase(place.back()));
    }
  }
};

TEST_P(SpoiledEntry, IsRefusedInOneLineWithFilePointerAndRemedy) {
  const Spoiled& spoiled = GetParam();
  edit(spoiled.file, [&](json& document) { spoil(document, spoiled); });
  const ConfigError error = error_of([&] {
    if (is_truth(spoiled.file)) {
      read_truth(path(spoiled.file));
    } else {
      static_cast<void>(read());
    }
  });
  EXPECT_THAT(error.source(), EndsWith(spoiled.file));
  EXPECT_EQ(error.pointer(), spoiled.pointer);
  EXPECT_THAT(error.message(), HasSubstr(spoiled.said));
  EXPECT_THAT(error.message(), testing::MatchesRegex(".+; .+")) << "what is wrong; what to do";
  const std::string what = error.what();
  EXPECT_EQ(what.find('\n'), std::string::npos);
  EXPECT_THAT(what, HasSubstr(error.source()));
  EXPECT_THAT(what, HasSubstr(error.message()));
}

INSTANTIATE_TEST_SUITE_P(
    Arm, SpoiledEntry,
    testing::Values(
        Spoiled{kArm, "/schema", "touchcal/arm/9", "/schema", "this program reads \"touchcal/arm/5\""},
        Spoiled{kArm, "/schema", "touchcal/arm/1", "/gears", "unknown key"},
        Spoiled{kArm, "/schema", std::nullopt, "", "\"schema\" is missing"},
        Spoiled{kArm, "/schema", 1, "/schema", "is a number"},
        Spoiled{kArm, "/colour", "yellow", "/colour", "unknown key \"colour\"; known here: schema, name"},
        Spoiled{kArm, "/a\nb", 1, "/a\nb", "unknown key \"a?b\""},
        Spoiled{kArm, "/name", "", "/name", "is empty"},
        Spoiled{kArm, "/name", "tx\n90", "/name", "control character"},
        Spoiled{kArm, "/frames/7", std::nullopt, "/frames", "wants 8 entries, has 7"},
        Spoiled{kArm, "/frames/2/j", 3, "/frames/2", "is frame 3 where frame 2 is expected"},
        Spoiled{kArm, "/frames/2/j", 2.5, "/frames/2/j", "whole number"},
        Spoiled{kArm, "/frames/2/j", std::nullopt, "/frames/2", "\"j\" is missing"},
        Spoiled{kArm, "/frames/0/alpha_deg", 0, "/frames/0/alpha_deg", "unknown key"},
        Spoiled{kArm, "/frames/3/theta_deg", 0, "/frames/3/theta_deg", "unknown key"},
        Spoiled{kArm, "/frames/7/gain", 1, "/frames/7/gain", "unknown key"},
        Spoiled{kArm, "/frames/7/theta_deg", -14.7, "/frames/7/theta_rad", "keep one of them"},
        Spoiled{kArm, "/frames/4/r_mm", std::nullopt, "/frames/4", "\"r_mm\" is missing"},
        Spoiled{kArm, "/frames/4/r_mm", nullptr, "/frames/4/r_mm", "is null; give a finite number"},
        Spoiled{kArm, "/frames/4/alpha_deg", std::nullopt, "/frames/4", "\"alpha_deg\" is missing"},
        Spoiled{kArm, "/frames/4/joint_type", "ball", "/frames/4/joint_type",
                "give \"revolute\" or \"prismatic\""},
        Spoiled{kArm, "/frames/4/gain", 0, "/frames/4/gain", "is 0"},
        Spoiled{kArm, "/frames/4/gain", 1e-300, "/frames/4/gain", "a joint that moves has a gain"},
        Spoiled{kArm, "/frames/4/gain", 1001, "/frames/4/gain", "give -1000 to 1000"},
        Spoiled{kArm, "/frames/4/r_mm", 100001, "/frames/4/r_mm", "give -100000 to 100000"},
        Spoiled{kArm, "/frames/4/std/d_mm", -0.3, "/frames/4/std/d_mm", "at least 0"},
        Spoiled{kArm, "/frames/4/std/beta_rad", -0.3, "/frames/4/std/beta_rad", "at least 0"},
        Spoiled{kArm, "/frames/4/std/d_deg", 1, "/frames/4/std/d_deg", "unknown key"},
        Spoiled{kArm, "/joint_limits_deg/1", json({147.5, -130}), "/joint_limits_deg/1", "not below"},
        Spoiled{kArm, "/joint_limits_deg/5", std::nullopt, "/joint_limits_deg", "wants 6 entries, has 5"},
        Spoiled{kArm, "/joint_max_speeds_deg_s/0", 0, "/joint_max_speeds_deg_s/0", "a number over 0"},
        Spoiled{kArm, "/gravity/masses", json::array(), "/gravity/masses", "at least 1"},
        Spoiled{kArm, "/gravity/masses/1/frame", 2, "/gravity/masses/1/frame", "each once"},
        Spoiled{kArm, "/gravity/masses/0/frame", 0, "/gravity/masses/0/frame", "from 1 to 7"},
        Spoiled{kArm, "/gravity/masses/0/mass_kg", 0, "/gravity/masses/0/mass_kg", "over 0"},
        Spoiled{kArm, "/gravity/down_in_frame_1", json({0, -1, -1}), "/gravity/down_in_frame_1",
                "give a unit vector"},
        Spoiled{kArm, "/gravity/compliance_rad_per_nm", json({1e-6}), "/gravity/compliance_rad_per_nm", "2"},
        Spoiled{kArm, "/gravity/compliance_rad_per_nm", json({1e-6, 1e-6, 1e-6}),
                "/gravity/compliance_rad_per_nm", "give two (joints 2 and 3) or six"},
        Spoiled{kArm, "/gravity/std_compliance_rad_per_nm", json({0, 0, 0, 0, 0, 0}), "/gravity/masses",
                "over 0 for at least one"},
        Spoiled{kArm, "/gravity/std_compliance_rad_per_nm/1", 2e-4, "/gravity/std_compliance_rad_per_nm/1",
                "0.0001"},
        Spoiled{kArm, "/gravity/std_compliance_rad_per_nm/1", -1e-6, "/gravity/std_compliance_rad_per_nm/1",
                "give 0 to 0.0001"},
        Spoiled{kArm, "/gravity/std_mass_share", 0, "/gravity/std_mass_share", "over 0"},
        Spoiled{kArm, "/warming/rise_k", 0, "/warming/rise_k", "over 0"},
        Spoiled{kArm, "/warming/expansion_per_k", 1, "/warming/expansion_per_k", "0.001"},
        Spoiled{kArm, "/warming/hours", 1, "/warming/hours", "unknown key"},
        Spoiled{kArm, "/gears/ripple_rad/2", 0.1, "/gears/ripple_rad/2", "0 to 0.01"},
        Spoiled{kArm, "/gears/backlash_rad", json({1e-5}), "/gears/backlash_rad", "wants 6 entries, has 1"},
        Spoiled{kArm, "/gears/std_harmonic_rad", 0, "/gears/std_harmonic_rad", "over 0"},
        Spoiled{kArm, "/gears/harmonics_rad", json({0}), "/gears/harmonics_rad", "wants 6 entries, has 1"},
        Spoiled{kArm, "/gears/harmonics_rad", json::array({{3, -3}, {0, 0}, {0, 0}, {0, 0}, {0, 0}, {0, 0}}),
                "/gears/harmonics_rad/0/0", "give -0.01 to 0.01"},
        Spoiled{kArm, "/gears/ripple_rad", json({1e-5, 1e-5, 1e-5, 1e-5, 1e-5}), "/gears/ripple_rad",
                "wants 6 entries, has 5"},
        Spoiled{kArm, "/gears/ripple_rad/0", -1e-5, "/gears/ripple_rad/0", "give 0 to 0.01"},
        Spoiled{kArm, "/gears/ripple_rad/0", "NaN", "/gears/ripple_rad/0", "give a finite number"},
        Spoiled{kArm, "/gears/repeatability_rad/5", nullptr, "/gears/repeatability_rad/5", "finite number"},
        Spoiled{kArm, "/gears/std_harmonic_rad", "NaN", "/gears/std_harmonic_rad", "finite number"},
        Spoiled{kArm, "/gears/std_harmonic_rad", -5e-5, "/gears/std_harmonic_rad", "over 0"},
        Spoiled{kArm, "/gears/ripple_periods_per_turn", json({118, 118, 96, 72, 60, 48}),
                "/gears/ripple_periods_per_turn", "unknown key"},
        Spoiled{kArm, "/gears/lubricant", "oil", "/gears/lubricant", "unknown key"},
        Spoiled{kArm, "/bodies/0/radius_mm", 0, "/bodies/0/radius_mm", "a number over 0"},
        Spoiled{kArm, "/bodies/0/frame", 8, "/bodies/0/frame", "0 to 7"},
        Spoiled{kArm, "/bodies/0/to_mm", json({0, 1}), "/bodies/0/to_mm", "wants 3 numbers, has 2"}));

INSTANTIATE_TEST_SUITE_P(
    Block, SpoiledEntry,
    testing::Values(
        Spoiled{kBlock, "/schema", "touchcal/arm/1", "/schema", "this program reads \"touchcal/block/4\""},
        Spoiled{kBlock, "/faces", json::array(), "/faces", "at least 1"},
        Spoiled{kBlock, "/faces/1/plane", 3, "/faces/1/plane", "is not 2"},
        Spoiled{kBlock, "/faces/1/outward", json({-1, 0, 0.1}), "/faces/1/outward", "give a unit vector"},
        Spoiled{kBlock, "/faces/1/outward", json({0, 0, 0}), "/faces/1/outward", "give a unit vector"},
        Spoiled{kBlock, "/faces/1/outward", json({1, 0, 0}), "/faces/1/center_mm",
                "does not lie on the plane"},
        Spoiled{kBlock, "/faces/1/offset_mm", 76, "/faces/1/center_mm", "does not lie on the plane"},
        Spoiled{kBlock, "/faces/1/edge_u", json({1, 0, 0}), "/faces/1/edge_u", "not perpendicular"},
        Spoiled{kBlock, "/faces/1/half_extent_mm", json({75, 0}), "/faces/1/half_extent_mm", "not over 0"},
        Spoiled{kBlock, "/faces/1/std_offset_mm", -1, "/faces/1/std_offset_mm", "at least 0"},
        Spoiled{kBlock, "/faces/1/place", "guessed", "/faces/1/place", "\"known\" or \"estimated\""},
        Spoiled{kBlock, "/faces/1/place", std::nullopt, "/faces/1", "\"place\" is missing"},
        Spoiled{kBlock, "/lengths/0/planes", json({3, 6}), "/lengths/0/planes/1", "1 to 5"},
        Spoiled{kBlock, "/lengths/0/planes", json({3, 3}), "/lengths/0/planes", "twice"},
        Spoiled{kBlock, "/lengths/0/planes", json({2, 3}), "/lengths/0/planes", "not parallel"},
        Spoiled{kBlock, "/lengths/0/value_mm", 0, "/lengths/0/value_mm", "over 0"},
        Spoiled{kBlock, "/lengths/0/value_mm", 150.05, "/lengths/0/value_mm", "0.05 mm from what"},
        Spoiled{kBlock, "/lengths/1/value_mm", 149.95, "/lengths/1/value_mm", "offsets give, 150 mm"},
        Spoiled{kBlock, "/lengths/0/value_mm", 150.024, "/lengths/0/value_mm", "correct the value"},
        Spoiled{kBlock, "/lengths/1/planes", json({5, 3}), "/lengths/1", "second length of these"},
        Spoiled{kBlock, "/temperature_c", std::nullopt, "/std_temperature_k", "without \"temperature_c\""},
        Spoiled{kBlock, "/std_temperature_k", std::nullopt, "", "\"std_temperature_k\" is missing"},
        Spoiled{kBlock, "/solids/0/max_mm", json({75, -200, 75}), "/solids/0", "not below max_mm"},
        Spoiled{kBlock, "/certificate", 3, "/certificate", "give an object"}));

INSTANTIATE_TEST_SUITE_P(
    Probe, SpoiledEntry,
    testing::Values(Spoiled{kProbe, "/stylus_radius_mm", std::nullopt, "", "unknown is not zero"},
                    Spoiled{kProbe, "/pretravel_mm", std::nullopt, "", "unknown is not zero"},
                    Spoiled{kProbe, "/stylus_radius_mm", 0, "/stylus_radius_mm", "over 0"},
                    Spoiled{kProbe, "/pretravel_mm", -0.01, "/pretravel_mm", "at least 0"},
                    Spoiled{kProbe, "/tip_is_contact_point", true, "/stylus_radius_mm", "no ball"},
                    Spoiled{kProbe, "/tip_is_contact_point", "yes", "/tip_is_contact_point", "true or false"},
                    Spoiled{kProbe, "/overtravel_mm", 0, "/overtravel_mm", "over 0"},
                    Spoiled{kProbe, "/bodies/0/frame", 6, "/bodies/0/frame", "7 to 7"}));

INSTANTIATE_TEST_SUITE_P(
    Recipe, SpoiledEntry,
    testing::Values(
        Spoiled{kRecipe, "/touches/planes", json({1, 2, 6}), "/touches/planes/2", "1 to 5"},
        Spoiled{kRecipe, "/touches/planes", json({1, 2, 2}), "/touches/planes/2", "twice"},
        Spoiled{kRecipe, "/touches/planes", json::array(), "/touches/planes", "at least 1"},
        Spoiled{kRecipe, "/touches/planes", "some", "/touches/planes", "\"all\""},
        Spoiled{kRecipe, "/touches/fit_per_plane", 0, "/touches/fit_per_plane", "whole number from 1"},
        Spoiled{kRecipe, "/touches/fit", 40, "/touches/fit", "one of them"},
        Spoiled{kRecipe, "/touches/criterion", "best", "/touches/criterion", "\"tip_box\""},
        Spoiled{kRecipe, "/touches/tip_rms_max_mm", 0.1, "/touches/tip_rms_max_mm", "give \"fit\""},
        Spoiled{kRecipe, "/identification/excluded", json({"alpha4", "alfa5"}), "/identification/excluded/1",
                "unknown parameter \"alfa5\""},
        Spoiled{kRecipe, "/identification/tried_last/1", "r2", "/identification/tried_last/1", "twice"},
        Spoiled{kRecipe, "/identification/formulation", "eq6", "/identification/formulation",
                "plane_coefficients"},
        Spoiled{kRecipe, "/identification/qr_tolerance", 0, "/identification/qr_tolerance", "at least 1e-20"},
        Spoiled{kRecipe, "/identification/weights", "equal", "/identification/weights",
                "\"columns\" or \"units\""},
        Spoiled{kRecipe, "/identification/robust", "yes", "/identification/robust", "true or false"},
        Spoiled{kRecipe, "/identification/prior", 1, "/identification/prior", "true or false"},
        Spoiled{kRecipe, "/identification/stiffness", "no", "/identification/stiffness",
                R"(give "on", "off" or "auto")"},
        Spoiled{kRecipe, "/identification/stiffness", true, "/identification/stiffness", "is true"},
        Spoiled{kRecipe, "/identification/ripple", "auto", "/identification/ripple", "raise \"schema\" to 3"},
        Spoiled{kRecipe, "/identification/hold_weak", 0, "/identification/hold_weak", "true or false"},
        Spoiled{kRecipe, "/identification/huber", true, "/identification/huber", "unknown key"}));

INSTANTIATE_TEST_SUITE_P(
    Cell, SpoiledEntry,
    testing::Values(
        Spoiled{kCell, "/schema", "touchcal/cell/9", "/schema", "\"touchcal/cell/7\""},
        Spoiled{kCell, "/arm", "../arms/none.json", "/arm", "there is no file"},
        Spoiled{kCell, "/arm", "../../arms", "/arm", "there is no file"},
        Spoiled{kCell, "/recipes/1", "nowhere.json", "/recipes/1", "there is no file"},
        Spoiled{kCell, "/recipes/1", "../../recipes/quick.json", "/recipes/1", "already there"},
        Spoiled{kCell, "/default_recipe", "edf-99", "/default_recipe", "\"edf-99\""},
        Spoiled{kCell, "/frames", json::parse(R"([{"j":3,"r_mm":1}])"), "/frames/0", "frames 0 and 7 only"},
        Spoiled{kCell, "/frames",
                json::parse(R"([{"j":0,"theta_deg":0,"r_mm":1},{"j":0,"theta_deg":0,"r_mm":1}])"),
                "/frames/1", "each once"},
        Spoiled{kCell, "/park_joints_deg", json({0, 0, 60, 0, 90}), "/park_joints_deg",
                "wants 6 numbers, has 5"},
        Spoiled{kCell, "/park_joints_deg", json({0, 0, 150, 0, 90, 0}), "/park_joints_deg",
                "outside its range"},
        Spoiled{kCell, "/nominal_miss_mm", 0, "/nominal_miss_mm", "0"},
        Spoiled{kCell, "/stylus_tilt_max_deg", 90, "/stylus_tilt_max_deg", "89"},
        Spoiled{kCell, "/touch_noise_mm", -1, "/touch_noise_mm", "at least 0"},
        Spoiled{kCell, "/acceptance/condition_number_max", 0.5, "/acceptance/condition_number_max",
                "give 1 to"},
        Spoiled{kCell, "/acceptance/lack_of_fit_p_min", 1, "/acceptance/lack_of_fit_p_min", "0 to 0.5"},
        Spoiled{kCell, "/acceptance/tip_box_rms_max_mm", 0, "/acceptance/tip_box_rms_max_mm", "over 0"},
        Spoiled{kCell, "/unknown_place_std", json{{"length_mm", 5}}, "/unknown_place_std",
                "\"angle_rad\" is missing"},
        Spoiled{kCell, "/unknown_place_std", json({{"length_mm", 5}, {"angle_rad", 0}}),
                "/unknown_place_std/angle_rad", "over 0"},
        Spoiled{kCell, "/speeds/travel_mm_s", 0, "/speeds/travel_mm_s", "over 0"},
        Spoiled{kCell, "/speeds/search_mm_s", 8.1, "/speeds/search_mm_s", "8"},
        Spoiled{kCell, "/speeds/search_mm_s", 1.5, "/speeds/second_mm_s", "1.5"},
        Spoiled{kCell, "/speeds/approach_mm_s", 20.1, "/speeds/approach_mm_s", "20"},
        Spoiled{kCell, "/speeds/second_mm_s", 1.5, "/speeds/second_mm_s", "pre-travel"},
        Spoiled{kCell, "/speeds/second_mm_s", 0, "/speeds/second_mm_s", "0"},
        Spoiled{kCell, "/speeds/second_mm_s", std::nullopt, "/speeds/second_backoff_mm", "no second touch"},
        Spoiled{kCell, "/speeds/second_backoff_mm", std::nullopt, "/speeds",
                "\"second_backoff_mm\" is missing"},
        Spoiled{kCell, "/speeds/second_backoff_mm", 0.4, "/speeds/second_backoff_mm", "give 0.5 to 5"},
        Spoiled{kCell, "/speeds/second_backoff_mm", 5.1, "/speeds/second_backoff_mm", "give 0.5 to 5"},
        Spoiled{kCell, "/deadlines/connect_ms", 0, "/deadlines/connect_ms", "whole number from 1"},
        Spoiled{kCell, "/deadlines/ready_ms", 0, "/deadlines/ready_ms", "whole number from 1"},
        Spoiled{kCell, "/deadlines/confirm_ms", 30001, "/deadlines/confirm_ms", "from 1000 to 30000"},
        Spoiled{kCell, "/controller/port", 65536, "/controller/port", "0 to 65535"},
        Spoiled{kCell, "/controller/host", std::nullopt, "/controller", "\"host\" is missing"},
        Spoiled{kCell, "/workspace_box/min_mm", json({1, 2}), "/workspace_box/min_mm",
                "wants 3 numbers, has 2"},
        Spoiled{kCell, "/keep_out_boxes", 3, "/keep_out_boxes", "give an array"},
        Spoiled{kCell, "/tools/gripper/position_mm/1", "x", "/tools/gripper/position_mm/1", "is a text"}));

INSTANTIATE_TEST_SUITE_P(
    Truth, SpoiledEntry,
    testing::Values(Spoiled{kTruth, "/schema", "touchcal/truth/5", "/schema", "\"touchcal/truth/4\""},
                    Spoiled{kTruth, "/errors/theta9_rad", 1, "/errors/theta9_rad", "unknown error"},
                    Spoiled{kTruth, "/errors/r0", 1, "/errors/r0", "\"r0_mm\""},
                    Spoiled{kTruth, "/errors/theta0_mm", 1, "/errors/theta0_mm", "\"theta0_rad\""},
                    Spoiled{kTruth, "/errors/r0_rad", 1, "/errors/r0_rad", "\"r0_mm\""},
                    Spoiled{kTruth, "/errors/theta0_deg", 1, "/errors/theta0_rad", "two units"},
                    Spoiled{kTruth, "/errors/r0_mm", nullptr, "/errors/r0_mm", "is null"}));

INSTANTIATE_TEST_SUITE_P(
    Effects, SpoiledEntry,
    testing::Values(
        Spoiled{kTruth, "/droop", json::object(), "/droop", "unknown key"},  // of a file of version 1
        Spoiled{kRealTruth, "/droop/compliance_rad_per_nm", json({1e-6}), "/droop/compliance_rad_per_nm",
                "2"},
        Spoiled{kRealTruth, "/droop/compliance_rad_per_nm/1", 1e-3, "/droop/compliance_rad_per_nm/1",
                "0 to 0.0001"},
        Spoiled{kRealTruth, "/droop/on", "yes", "/droop/on", "is a text"},
        Spoiled{kRealTruth, "/ripple/joints/5", std::nullopt, "/ripple/joints", "6"},
        Spoiled{kRealTruth, "/ripple/joints/2/phase_deg", std::nullopt, "/ripple/joints/2",
                "\"phase_deg\" is missing"},
        Spoiled{kRealTruth, "/ripple/joints/2/periods_per_turn", -1, "/ripple/joints/2/periods_per_turn",
                "0 to 10000"},
        Spoiled{kRealTruth, "/ripple/joints/2/periods_per_turn", 9000, "/ripple/joints/2", "no gear"},
        Spoiled{kRealTruth, "/backlash/width_rad", json({1e-5, 1e-5}), "/backlash/width_rad", "6"},
        Spoiled{kRealTruth, "/backlash/width_rad/3", -1e-5, "/backlash/width_rad/3", "0 to 0.01"},
        Spoiled{kRealTruth, "/thermal/arm_time_constant_s", 0, "/thermal/arm_time_constant_s", "1 to"},
        Spoiled{kRealTruth, "/thermal/arm_rise_k", 400, "/thermal/arm_rise_k", "-50 to 50"},
        Spoiled{kRealTruth, "/thermal/arm_rise_k", std::nullopt, "/thermal", "\"arm_rise_k\" is missing"},
        Spoiled{kRealTruth, "/block/offsets_mm/0", 11, "/block/offsets_mm/0", "-10 to 10"},
        Spoiled{kRealTruth, "/probe/lobes_mm", 2, "/probe/lobes_mm", "-1 to 1"},
        Spoiled{kRealTruth, "/probe/noise_mm", -0.001, "/probe/noise_mm", "0 to 1"},
        Spoiled{kRealTruth, "/probe/lobe_direction_rad", 1, "/probe/lobe_direction_rad", "keep one"},
        Spoiled{kRealTruth, "/repeatability/std_rad", std::nullopt, "/repeatability",
                "\"std_rad\" is missing"},
        Spoiled{kRealTruth, "/encoder/step_deg", 2, "/encoder/step_deg", "0 to 1"},
        Spoiled{kRealTruth, "/surprise", 1, "/surprise", "unknown key"}));

TEST_F(ReadConfig, TheCopyIsReadAsLongAsNothingIsSpoiled) { EXPECT_EQ(read().name, "demo"); }

TEST_F(ReadConfig, ASpeedAtWhichTheStylusWouldBendTooFarIsRefused) {
  const Speeds speeds = read().speeds;
  const auto with_overtravel = [&](double overtravel_m) {
    edit(kProbe, [&](json& document) { document["overtravel_mm"] = calib::mm_from_metres(overtravel_m); });
  };
  with_overtravel(2.001 * calib::stop_distance_m(speeds.approach_m_s));
  EXPECT_EQ(read().speeds.approach_m_s, speeds.approach_m_s);
  with_overtravel(1.999 * calib::stop_distance_m(speeds.approach_m_s));
  EXPECT_EQ(error_of([&] { static_cast<void>(read()); }).pointer(), "/speeds/approach_mm_s");
  edit(kCell, [](json& document) { document["speeds"]["approach_mm_s"] = 1; });
  with_overtravel(1.999 * calib::stop_distance_m(speeds.search_m_s));
  const ConfigError error = error_of([&] { static_cast<void>(read()); });
  EXPECT_EQ(error.pointer(), "/speeds/search_mm_s");
  EXPECT_THAT(error.message(), HasSubstr("overtravel_mm; go slower"));
}

TEST_F(ReadConfig, WithoutASecondTouchTheFirstOneCounts) {
  EXPECT_EQ(read().speeds.contact_m_s(), read().speeds.second.value().speed_m_s);
  edit(kCell, [](json& document) {
    document["speeds"].erase("second_mm_s");
    document["speeds"].erase("second_backoff_mm");
  });
  EXPECT_EQ(error_of([&] { static_cast<void>(read()); }).pointer(), "/speeds/search_mm_s")
      << "the pre-travel";
  edit(kProbe, [](json& document) { document["calibration_speed_mm_s"] = 8; });
  const Speeds speeds = read().speeds;
  EXPECT_FALSE(speeds.second);
  EXPECT_EQ(speeds.contact_m_s(), speeds.search_m_s);
}

TEST_F(ReadConfig, FilesThatCannotBeReadAreNamed) {
  const auto what = [](const std::filesystem::path& file) {
    return std::string(error_of([&] { static_cast<void>(read_cell(file)); }).what());
  };
  const std::string root = folder_.path().string();
  EXPECT_EQ(what(path("none.json")), root + "/none.json: there is no such file; check the path");
  EXPECT_EQ(what(path("cells")), root + "/cells: is a folder; name a file in it");
  EXPECT_EQ(what(path("cells/demo/cell.json/x")),
            root + "/cells/demo/cell.json/x: there is no such file; check the path");
  EXPECT_EQ(what(folder_.write("empty.json", "")), root + "/empty.json: is empty; give a document");
  EXPECT_THAT(what(folder_.write("big.json", std::string(2'000'000, ' '))),
              HasSubstr("larger than 1048576 bytes"));
  EXPECT_THAT(what(folder_.write("text.json", "hello\n")),
              HasSubstr("text.json: line 1, column 1: not JSON"));
  EXPECT_THAT(what(folder_.write("list.json", "[]")),
              HasSubstr("is an array; give an object with \"schema\""));
}

TEST_F(ReadConfig, ANamedFileThatIsNotJsonIsNamedItself) {
  folder_.write(kBlock, "{\"schema\": \"touchcal/block/1\",\n\"name\": NaN}");
  const ConfigError error = error_of([&] { static_cast<void>(read()); });
  EXPECT_THAT(error.what(), HasSubstr("cells/demo/block.json: line 2, column"));
}

TEST_F(ReadConfig, ACellOverridesPlaceAndToolOfItsArm) {
  edit(kCell, [](json& cell) {
    cell["frames"] = json::parse(
        R"([{"j":0,"theta_deg":90,"r_mm":100,"std":{"r_mm":1}},
            {"j":7,"alpha_rad":0.1,"d_mm":2,"theta_deg":0,"r_mm":300,"beta_deg":0}])");
  });
  const Cell cell = read();
  EXPECT_DOUBLE_EQ(cell.arm.model.links[0].theta_rad, std::numbers::pi / 2);
  EXPECT_DOUBLE_EQ(cell.arm.model.links[0].r_m, 0.1);
  EXPECT_DOUBLE_EQ(cell.arm.model.links[7].alpha_rad, 0.1);
  EXPECT_DOUBLE_EQ(cell.arm.model.links[7].d_m, 0.002);
  EXPECT_DOUBLE_EQ(cell.arm.std_errors[static_cast<std::size_t>(*calib::error_parameter_index("r0"))].value(),
                   0.001);
  EXPECT_FALSE(
      cell.arm.std_errors[static_cast<std::size_t>(*calib::error_parameter_index("r7"))].has_value());
}

TEST_F(ReadConfig, AnglesMayBeGivenInRadians) {
  const Cell in_degrees = read();
  edit(kArm, [](json& arm) {
    arm["frames"][2].erase("alpha_deg");
    arm["frames"][2]["alpha_rad"] = -std::numbers::pi / 2;
  });
  EXPECT_DOUBLE_EQ(read().arm.model.links[2].alpha_rad, in_degrees.arm.model.links[2].alpha_rad);
}

TEST_F(ReadConfig, ANearlyUnitNormalIsMadeOne) {
  edit(kBlock, [](json& block) { block["faces"][0]["outward"] = {0.0, 0.0, -1.0 + 5e-7}; });
  EXPECT_DOUBLE_EQ(read().block.faces[0].plane.outward.norm(), 1.0);
}

TEST_F(ReadConfig, ToolsTurnAsInVal3) {
  edit(kCell, [](json& cell) {
    cell["tools"]["bent"] = json::parse(R"({"position_mm":[10,20,30],"rotation_deg":[90,0,90]})");
  });
  const Eigen::Isometry3d wrist_from_tool = read().tools.at("bent");
  // Rot(x, 90) Rot(z, 90) takes x to Rot(x, 90) y = z.
  EXPECT_TRUE((wrist_from_tool * Eigen::Vector3d::UnitX()).isApprox(Eigen::Vector3d(0.01, 0.02, 1.03)));
}

}  // namespace
}  // namespace cell
