#include "service/setup/setup_check.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>

#include "config/config_error.hpp"
#include "tests/service/setup/made_cell.hpp"

namespace cell {
namespace {

using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;

class SetupChecks : public ::testing::Test {
 protected:
  SetupCheck check(const std::string& members, const SetupLanguage& language = setup_english()) {
    return check_setup("body", R"({"schema":"touchcal/setup/1")" + members + "}",
                       {.shipped_config = kSourceDir / "config", .temporary = folder_.path()}, language);
  }

  Folder folder_;
};

TEST_F(SetupChecks, OfGoodAnswersHaveTheFilesThatTheCommandWritesAndLeaveNone) {
  const SetupCheck good = check(R"(,"name":"press 3")");
  EXPECT_THAT(good.refused, IsEmpty());
  EXPECT_EQ(good.passes, true);
  SetupAnswers answers;
  answers.name = "press 3";
  EXPECT_EQ(good.files, files_of(answers));
  EXPECT_THAT(good.scene_svg, HasSubstr("<svg"));
  EXPECT_TRUE(std::filesystem::is_empty(folder_.path()));
}

TEST_F(SetupChecks, DrawWhatIsKnownBesideWhatIsRefused) {
  const SetupCheck wrong = check(
      R"(,"nominal_miss_mm":-1,"workspace_box":{"name":"<script>","min_mm":[0,-9,0],"max_mm":[9,0,9]})");
  ASSERT_EQ(wrong.refused.size(), 1U);
  EXPECT_EQ(wrong.refused[0].pointer, "/nominal_miss_mm");
  EXPECT_EQ(wrong.passes, false);
  EXPECT_THAT(wrong.files, IsEmpty());
  EXPECT_THAT(wrong.scene_svg, HasSubstr("&lt;script&gt;"));
  EXPECT_THAT(wrong.scene_svg, Not(HasSubstr("<script>")));
}

TEST_F(SetupChecks, RefuseWhatTheAnswersAreTogether) {
  const SetupCheck clash = check(R"(,"park_joints_deg":[0,60,90,0,30,0])");
  EXPECT_EQ(clash.passes, false);
  ASSERT_EQ(clash.refused.size(), 1U);
  EXPECT_EQ(clash.refused[0].pointer, "/park_joints_deg");
  EXPECT_THAT(clash.refused[0].remedy, HasSubstr("give another posture"));
  EXPECT_THAT(clash.scene_svg, HasSubstr("<svg")) << "it shows why";
  const SetupCheck in_a_file = check(R"(,"block":{"places":[{"name":"first","position_mm":[0,-200,0]}]})");
  EXPECT_EQ(in_a_file.passes, false);
  ASSERT_THAT(in_a_file.refused, Not(IsEmpty()));
  EXPECT_EQ(in_a_file.refused[0].file, "block.json") << in_a_file.refused[0].sentence;
}

TEST_F(SetupChecks, ReadNoFileThatTheAnswersName) {
  const std::string secret = (folder_.path() / "secret").string();
  folder_.write("secret", "touch no one");
  for (const std::string& arm :
       {R"({"file":")" + secret + R"("})", R"({"urdf":")" + secret + R"(","base_link":"a","tip_link":"b"})",
        R"({"dh":")" + secret + R"("})", std::string(R"({"file":"../arms/tx90"})"),
        std::string(R"({"file":"tx90.json"})")}) {
    const SetupCheck elsewhere = check(",\"arm\":" + arm);
    EXPECT_EQ(elsewhere.passes, std::nullopt) << arm;
    EXPECT_THAT(elsewhere.refused, IsEmpty()) << arm;
    EXPECT_EQ(elsewhere.scene_svg, "") << arm;
    EXPECT_THAT(elsewhere.remarks, ::testing::ElementsAre(HasSubstr("is read at the cell"))) << arm;
  }
  const SetupCheck unknown = check(R"(,"arm":{"file":"tx91"})");
  EXPECT_EQ(unknown.passes, false);
  EXPECT_EQ(unknown.refused.at(0).pointer, "/arm/file");
  EXPECT_EQ(unknown.refused.at(0).remedy, "shipped are three-parallel, tx60, tx90");
}

TEST_F(SetupChecks, OfOddAnswersEndWithAWordAndNotWithAnError) {
  for (
      const char* odd :
      {R"(,"base":{"position_mm":[1e5,-1e5,1e5],"rotation_deg":[1e5,1e5,1e5]})",
       R"(,"base":{"position_mm":[0,0,0],"rotation_deg":[90,0,0]})",
       R"(,"keep_out_boxes":[{"name":"all","min_mm":[-1e5,-1e5,-1e5],"max_mm":[1e5,1e5,1e5]}])",
       R"(,"block":{"size_mm":[10,10,10],"ground_plate":false,"sides":[{"side":"-x"},{"side":"+x"},{"side":"-z"},{"side":"-y"}]})",
       R"(,"block":{"size_mm":[2000,2000,2000],"plate_mm":[9999,9999,9999]})",
       R"(,"tools":[{"name":"a","position_mm":[0,0,0]},{"name":"a","position_mm":[0,0,0]}])"}) {
    const SetupCheck answered = check(odd);
    EXPECT_EQ(answered.passes.value_or(false), answered.refused.empty()) << odd;
    for (const RefusedAnswer& refused : answered.refused) EXPECT_NE(refused.sentence, "") << odd;
  }
}

TEST_F(SetupChecks, CallTheViewsInTheirLanguage) {
  EXPECT_THAT(check("").scene_svg, HasSubstr("seen from above"));
  EXPECT_THAT(check("", *setup_language("fr")).scene_svg, HasSubstr("vue de dessus"));
}

}  // namespace
}  // namespace cell
