#include "config/probe_file.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "calib_core/geometry/units.hpp"
#include "copied_config.hpp"

namespace cell {
namespace {

using nlohmann::json;
using testing::HasSubstr;

class ProbeFile : public CopiedConfig {
 protected:
  /// The shipped probe with these keys, as of this schema.
  void write(const json& keys, std::string_view schema = kProbeSchema) const {
    edit(kProbe, [&](json& probe) {
      for (const char* key : {"pretravel_tilt_mm", "std_pretravel_tilt_mm", "lobes_mm", "std_lobes_mm"})
        probe.erase(key);
      if (schema == kProbeSchema)
        probe["schema"] = schema;
      else
        lower_schema(probe, schema);
      probe.update(keys);
    });
  }
  [[nodiscard]] Probe probe() const { return read_probe(path(kProbe)); }
  [[nodiscard]] ConfigError error() const {
    return error_of([&] { static_cast<void>(probe()); });
  }
};

TEST_F(ProbeFile, TellsWhatAPushFromTheSideAddsToThePretravel) {
  write({{"pretravel_tilt_mm", 0.002},
         {"std_pretravel_tilt_mm", 0.0004},
         {"lobes_mm", 0.0015},
         {"std_lobes_mm", 0.0003},
         {"lobe_direction_deg", 25}});
  const calib::SidewaysPretravel sideways = probe().stylus.sideways;
  EXPECT_DOUBLE_EQ(sideways.tilt_m, 2e-6);
  EXPECT_DOUBLE_EQ(sideways.lobes_m, 1.5e-6);
  EXPECT_DOUBLE_EQ(sideways.lobe_direction_rad, calib::radians_from_degrees(25.0));
  EXPECT_DOUBLE_EQ(probe().std_pretravel_tilt_m, 4e-7);
  const calib::ArtefactKnowledge knowledge = artefact_knowledge(read());
  EXPECT_DOUBLE_EQ(knowledge.stylus.sideways.lobes_m, 1.5e-6);
  EXPECT_TRUE(calib::make_artefact(knowledge).std_sideways_m.isApprox(Eigen::Vector3d(4e-7, 3e-7, 3e-7)));
}

TEST_F(ProbeFile, OfTheFirstSchemaHasOnePretravelForAllPushes) {
  write(json::object(), kFirstProbeSchema);
  EXPECT_TRUE(probe().stylus.sideways.is_zero());
  for (const char* key : {"pretravel_tilt_mm", "std_pretravel_tilt_mm", "lobes_mm", "std_lobes_mm"}) {
    write({{key, 0.001}}, kFirstProbeSchema);
    EXPECT_EQ(error().pointer(), std::string("/") + key);
    EXPECT_THAT(error().message(), HasSubstr("raise \"schema\" to 2"));
  }
}

TEST_F(ProbeFile, HasASerialNumberFromTheThirdSchemaOn) {
  write({{"serial", "H-8842"}});
  EXPECT_EQ(probe().serial, "H-8842");
  write({{"serial", "H-8842"}}, kSecondProbeSchema);
  EXPECT_EQ(error().pointer(), "/serial");
  EXPECT_THAT(error().message(), HasSubstr("in a probe of version 2; raise \"schema\" to 3"));
  write(json::object(), kSecondProbeSchema);
  EXPECT_FALSE(probe().serial) << "files of the second are read";
}

TEST_F(ProbeFile, MayHaveTheMakersDeviationsAlone) {
  write({{"std_pretravel_tilt_mm", 0.003}, {"std_lobes_mm", 0.001}});
  EXPECT_TRUE(probe().stylus.sideways.is_zero());
  EXPECT_DOUBLE_EQ(probe().std_lobes_m, 1e-6);
}

TEST_F(ProbeFile, RefusesLobesWithoutADirectionAndADirectionWithoutLobes) {
  write({{"lobes_mm", 0.001}});
  EXPECT_EQ(error().pointer(), "/lobes_mm");
  EXPECT_THAT(error().message(), HasSubstr("add \"lobe_direction_deg\""));
  write({{"lobe_direction_deg", 25}});
  EXPECT_EQ(error().pointer(), "/lobe_direction_deg");
  EXPECT_THAT(error().message(), HasSubstr("add \"lobes_mm\""));
}

TEST_F(ProbeFile, RefusesFiguresThatTogetherTripBeforeTheTouchOrBeyondTheOvertravel) {
  write({{"pretravel_tilt_mm", -0.9}});
  EXPECT_THAT(error().message(), HasSubstr("before it touches"));
  write({{"pretravel_mm", 6.4}, {"lobes_mm", 0.2}, {"lobe_direction_deg", 0}});
  EXPECT_THAT(error().message(), HasSubstr("beyond \"overtravel_mm\""));
}

TEST_F(ProbeFile, RefusesWhatNoProbeHas) {
  write({{"pretravel_tilt_mm", 1.5}});
  EXPECT_EQ(error().pointer(), "/pretravel_tilt_mm");
  write({{"std_lobes_mm", -0.001}});
  EXPECT_EQ(error().pointer(), "/std_lobes_mm");
  folder_.write(kProbe, R"({"schema":"touchcal/probe/2","name":"needle","tip_is_contact_point":true,
    "std_lobes_mm":0.001,"overtravel_mm":5,"calibration_speed_mm_s":2,"bodies":[]})");
  EXPECT_EQ(error().pointer(), "/std_lobes_mm");
  EXPECT_THAT(error().message(), HasSubstr("no ball"));
}

}  // namespace
}  // namespace cell
