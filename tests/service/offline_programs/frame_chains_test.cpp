#include "service/offline_programs/frame_chains.hpp"

#include <gmock/gmock.h>

#include "tests/config/folder.hpp"
#include "tests/service/offline_programs/val3_texts.hpp"

namespace cell {
namespace {

using ::testing::HasSubstr;

std::string chain_refusal(const std::string& datas) {
  return error_of([&] {
           const XmlText xml("cell.dtx", new_data(datas));
           const StoredData data = read_stored_data(xml);
           const FrameChains chains(xml, data, 1.0);
         })
      .what();
}

TEST(FrameChains, GoThroughAllFathersToTheWorld) {
  const XmlText xml(
      "cell.dtx",
      new_data(
          variable("fPiece", "frame", value("key=\"1\" y=\"50\" rz=\"90\" fatherId=\"fTable[0]\""), "3") +
          variable("fTable", "frame", value("key=\"0\" x=\"100\" rz=\"90\" fatherId=\"world[0]\""))));
  const StoredData data = read_stored_data(xml);
  const FrameChains chains(xml, data, 1.0);
  const Eigen::Isometry3d piece = chains.find({.name = "fPiece", .key = "1"}).world_from_frame;
  EXPECT_TRUE((piece * Eigen::Vector3d(0.01, 0, 0)).isApprox(Eigen::Vector3d(0.04, 0, 0)));
  EXPECT_TRUE((piece * Eigen::Vector3d(0, 0.01, 0)).isApprox(Eigen::Vector3d(0.05, -0.01, 0)));
  EXPECT_TRUE(chains.find({.name = "world"}).world_from_frame.isApprox(Eigen::Isometry3d::Identity()));
  EXPECT_TRUE(
      chains.find({.name = "fPiece", .key = "2"}).world_from_frame.isApprox(Eigen::Isometry3d::Identity()))
      << "left out, and so the world";
  EXPECT_THAT(chains.find({.alias = "lib", .name = "fFar"}).unknown,
              HasSubstr("the frame fFar is in the library lib"));
  const FrameChains inches(xml, data, 25.4);
  EXPECT_NEAR(inches.find({.name = "fTable"}).world_from_frame.translation().x(), 2.54, 1e-12);
}

TEST(FrameChains, DoNotKnowAPlaceInAFrameThatWasTouchedWithTheNominalArm) {
  const XmlText xml("cell.dtx",
                    new_data(variable("fPiece", "frame", value("key=\"0\" y=\"50\" fatherId=\"fTable[0]\"")) +
                             variable("fTable", "frame", value("key=\"0\" fatherId=\"world[0]\"")) +
                             variable("fOther", "frame", value("key=\"0\" fatherId=\"world[0]\""))));
  const StoredData data = read_stored_data(xml);
  const FrameChains chains(xml, data, 1.0, {.names = {"fTable"}, .source = "points.list"});
  EXPECT_THAT(chains.find({.name = "fPiece"}).unknown,
              HasSubstr("the frame fTable was touched with the nominal arm, says points.list (taught)"));
  EXPECT_EQ(chains.find({.name = "fOther"}).unknown, "");
}

TEST(FrameChains, RefuseFathersThatAreNotThere) {
  EXPECT_EQ(
      chain_refusal(variable("p", "pointRx", value("key=\"0\" fatherId=\"fGone[0]\""))),
      "cell.dtx:5: p[0] is given in \"fGone\", which is not in the file; add the frame, or give another "
      "father");
  EXPECT_THAT(
      chain_refusal(variable("f", "frame", value("key=\"0\" fatherId=\"g[0]\"")) + variable("g", "num", "")),
      HasSubstr("f[0] is given in \"g\", which is a num; give a frame"));
  EXPECT_THAT(chain_refusal(variable("p", "pointRx", value("key=\"0\" fatherId=\"g[2]\"")) +
                            variable("g", "frame", "", "2")),
              HasSubstr("p[0] is given in \"g\", which has no element [2]"));
}

TEST(FrameChains, RefuseFramesThatAreGivenInEachOther) {
  EXPECT_THAT(chain_refusal(variable("a", "frame", value("key=\"0\" fatherId=\"b[0]\"")) +
                            variable("b", "frame", value("key=\"0\" fatherId=\"c[0]\"")) +
                            variable("c", "frame", value("key=\"0\" fatherId=\"b[0]\""))),
              HasSubstr("b[0] is given in itself, by way of its father; give another father"));
  EXPECT_THAT(chain_refusal(variable("a", "frame", value("key=\"0\" fatherId=\"a[0]\""))),
              HasSubstr("a[0] is given in itself"));
}

TEST(FrameChains, MayBeAsLongAsTheFile) {
  std::string values = value("key=\"0\" x=\"1\" fatherId=\"world[0]\"");
  constexpr int kCount = 20'000;
  for (int i = 1; i < kCount; ++i)
    values +=
        value("key=\"" + std::to_string(i) + "\" x=\"1\" fatherId=\"f[" + std::to_string(i - 1) + "]\"");
  const XmlText xml("cell.dtx", new_data(variable("f", "frame", values, std::to_string(kCount))));
  const StoredData data = read_stored_data(xml);
  const FrameChains chains(xml, data, 1.0);
  const auto last = chains.find({.name = "f", .key = std::to_string(kCount - 1)});
  EXPECT_NEAR(last.world_from_frame.translation().x(), 1e-3 * kCount, 1e-9);
}

}  // namespace
}  // namespace cell
