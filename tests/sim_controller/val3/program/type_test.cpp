// Types by their words, and the fields of the language's structures.
#include "sim_controller/val3/program/type.hpp"

#include <gtest/gtest.h>

#include "sim_controller/val3/program/application.hpp"

namespace val3 {
namespace {

TEST(Types, AreNamedAsFilesOfAllVersionsNameThem) {
  EXPECT_EQ(kind_named("num"), Kind::kNum);
  EXPECT_EQ(kind_named("joint"), Kind::kJoint);
  EXPECT_EQ(kind_named("jointRx"), Kind::kJoint);
  EXPECT_EQ(kind_named("pointRs"), Kind::kPointRs);
  EXPECT_EQ(kind_named("screen"), Kind::kScreen);
  EXPECT_EQ(kind_named("Num"), Kind::kVoid);
  EXPECT_EQ(kind_named("blend"), Kind::kVoid);  // no variable is one
}

TEST(Types, AreWrittenByOneNameEach) {
  EXPECT_EQ(name_of(Kind::kJoint), "jointRx");
  EXPECT_EQ(name_of(Kind::kVoid), "nothing");
  EXPECT_EQ(name_of(Kind::kBlend), "blend");
  Application application;
  application.user_types.push_back({.name = "Pair"});
  EXPECT_EQ(name_of(application, {Kind::kUser, 0}), "Pair");
  EXPECT_EQ(name_of(application, {Kind::kNum, -1}), "num");
}

TEST(Types, HaveTheFieldsOfTheManualInItsOrder) {
  EXPECT_EQ(field_of(Kind::kTrsf, "rz"), Kind::kNum);
  EXPECT_EQ(field_of(Kind::kPoint, "config"), Kind::kConfig);
  EXPECT_EQ(field_of(Kind::kPointRs, "config"), Kind::kConfigRs);
  EXPECT_EQ(field_of(Kind::kTool, "gripper"), Kind::kDio);
  EXPECT_EQ(field_of(Kind::kMdesc, "blend"), Kind::kBlend);
  EXPECT_EQ(field_of(Kind::kJointRs, "j5"), Kind::kVoid);
  EXPECT_EQ(field_of(Kind::kNum, "x"), Kind::kVoid);
  EXPECT_EQ(fields_of(Kind::kMdesc)[3].name, "tvel");
  EXPECT_EQ(fields_of(Kind::kTrsf).size(), 6U);
}

}  // namespace
}  // namespace val3
