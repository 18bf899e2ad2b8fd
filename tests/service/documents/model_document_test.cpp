#include "service/documents/model_document.hpp"

#include <gmock/gmock.h>

#include <functional>
#include <nlohmann/json.hpp>
#include <set>

#include "service/base/digest.hpp"
#include "service/documents/document_error.hpp"

namespace cell {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::SizeIs;

constexpr const char* kArmJson = R"({"schema":"touchcal/arm/3","name":"tx90"})";
constexpr const char* kResultJson =
    R"({"tip_uncertainty":{"expanded":{"k":2.0,"box_max_mm":0.213},"later_figure":1},
        "parameters":[{"name":"r0","error":0.125}],"nongeometric_parameters":[],"touch_count":100})";

StoredRun accepted_run() {
  return {.id = 7,
          .block_temperature = StoredTemperature{.celsius = 21.5},
          .config_digest = "abc",
          .conditions_json = R"({"arm_moving_min":45})"};
}

std::vector<StoredTouch> touches_of_run() {
  return {{.number = 1,
           .plane = 2,
           .role = calib::TouchRole::kHeldOut,
           .joints = {1, -2, 3, -4, 5, -6},
           .overtravel_dmm = 3,
           .captured_at = "then",
           .session = 4,
           .sequence = 5,
           .aimed_with = -1},
          {.number = 2,
           .plane = 3,
           .captured_at = "then",
           .noise_um = 61.5,
           .first = FirstContact{.joints = {6, 5, 4, 3, 2, 1}},
           .again = cs8::JointsMicrodeg{1, 1, 1, 1, 1, 1}}};
}

TEST(ModelHash, IsThatOfTheCanonicalTextThatSurfacesDescribes) {
  const std::string text =
      R"({"arm":"{\"schema\":\"touchcal/arm/3\",\"name\":\"tx90\"}","config_digest":"abc","run_id":"7",)"
      R"("touches":[{"again_microdeg":null,"aimed_with":-1,"captured_at":"then","first_microdeg":null,)"
      R"("first_source":null,"joints_microdeg":[1,-2,3,-4,5,-6],"noise_um":null,"number":1,"overtravel_dmm":3,)"
      R"("plane":2,"role":"held_out","sequence":5,"session":4,"source":"latched"},)"
      R"({"again_microdeg":[1,1,1,1,1,1],"aimed_with":0,"captured_at":"then",)"
      R"("first_microdeg":[6,5,4,3,2,1],"first_source":"latched","joints_microdeg":[0,0,0,0,0,0],)"
      R"("noise_um":61.5,"number":2,"overtravel_dmm":0,"plane":3,"role":"fit","sequence":0,"session":0,)"
      R"("source":"latched"}]})";
  EXPECT_EQ(model_hash(accepted_run(), touches_of_run(), kArmJson), sha256_hex(text));
}

TEST(ModelOfAnotherArm, IsOneOfAnotherNameOrAnotherSerialNumber) {
  Cell cell;
  cell.arm.name = "tx90";
  ModelDocument model;
  model.run_id = "7";
  model.arm = "tx60";
  EXPECT_THAT(why_other_arm(model, cell).value_or(""), AllOf(HasSubstr("'tx60'"), HasSubstr("'tx90'")));
  model.arm = "tx90";
  EXPECT_FALSE(why_other_arm(model, cell));
  model.arm_serial = "F12-1";
  EXPECT_FALSE(why_other_arm(model, cell)) << "nobody says which arm the cell has";
  cell.arm_serial = "F12-2";
  EXPECT_THAT(why_other_arm(model, cell).value_or(""), AllOf(HasSubstr("'F12-1'"), HasSubstr("'F12-2'")));
  model.arm_serial = "F12-2";
  EXPECT_FALSE(why_other_arm(model, cell));
  model.arm_serial.reset();
  EXPECT_FALSE(why_other_arm(model, cell)) << "the run is older than the number";
}

TEST(ModelHash, IsAnotherForAnyOtherRawFigure) {
  std::set<std::string> hashes{model_hash(accepted_run(), touches_of_run(), kArmJson)};
  const auto add = [&](const std::function<void(StoredRun&, std::vector<StoredTouch>&)>& change) {
    StoredRun run = accepted_run();
    auto touches = touches_of_run();
    change(run, touches);
    hashes.insert(model_hash(run, touches, kArmJson));
  };
  add([](StoredRun& run, auto&) { run.id = 8; });
  add([](StoredRun& run, auto&) { run.config_digest.reset(); });
  add([](auto&, auto& touches) { touches[0].joints[5] += 1; });
  add([](auto&, auto& touches) { touches[0].role = calib::TouchRole::kFit; });
  add([](auto&, auto& touches) { touches[1].first->joints[0] += 1; });
  add([](auto&, auto& touches) { touches[1].again.reset(); });
  add([](auto&, auto& touches) { touches[1].noise_um = 61.6; });
  add([](auto&, auto& touches) { touches[1].plane = 1; });
  add([](auto&, auto& touches) { touches.pop_back(); });
  hashes.insert(model_hash(accepted_run(), touches_of_run(), R"({"schema":"touchcal/arm/3","name":"tx60"})"));
  EXPECT_THAT(hashes, SizeIs(11));
}

TEST(ModelDocumentTest, HoldsWhatTheRunWasAndPassesOnWhatItsResultSaid) {
  const ModelDocument model = model_of(accepted_run(), touches_of_run(), kArmJson, kResultJson);
  const auto json = nlohmann::json::parse(document_text(model));
  EXPECT_EQ(json.at("schema"), "touchcal/model/1");
  EXPECT_EQ(json.at("hash"), model_hash(accepted_run(), touches_of_run(), kArmJson));
  EXPECT_EQ(json.at("run_id"), "7");
  EXPECT_EQ(json.at("arm"), "tx90");
  EXPECT_EQ(json.at("arm_moving_min"), 45);
  EXPECT_EQ(json.at("block_temperature_c"), 21.5);
  EXPECT_EQ(json.at("parameters").at(0).at("error"), 0.125);
  EXPECT_EQ(json.at("tip_uncertainty").at("later_figure"), 1) << "what this version does not know as well";
  for (const char* unknown :
       {"proof_run_id", "arm_serial", "controller_serial", "valid_until", "approved_by"})
    EXPECT_TRUE(json.at(unknown).is_null()) << unknown;
  const ModelDocument again = read_model(document_text(model));
  EXPECT_EQ(document_text(again), document_text(model));
  EXPECT_EQ(again.tip_uncertainty.value.expanded.box_max_mm, 0.213);
}

TEST(ModelDocumentTest, HasTheSerialNumbersThatTheRunWasMadeWith) {
  StoredRun run = accepted_run();
  run.conditions_json = R"({"arm_serial":"F09-1","controller_serial":"F09-C-2"})";
  const ModelDocument model = model_of(run, touches_of_run(), kArmJson, kResultJson);
  EXPECT_EQ(model.arm_serial, "F09-1");
  EXPECT_EQ(model.controller_serial, "F09-C-2");
  EXPECT_EQ(model.hash, model_hash(accepted_run(), touches_of_run(), kArmJson))
      << "the hash is over raw data";
}

TEST(ModelDocumentTest, WhatIsNoArmIsRefused) {
  EXPECT_THROW((void)model_of(accepted_run(), {}, "{}", kResultJson), DocumentError);
  EXPECT_THROW((void)name_of_arm("no JSON"), DocumentError);
}

TEST(ModelDocumentTest, WarmthThatNobodyGaveIsNotMadeUp) {
  StoredRun run = accepted_run();
  run.conditions_json.reset();
  EXPECT_FALSE(model_of(run, {}, kArmJson, kResultJson).arm_moving_min);
  run.conditions_json = "[]";
  EXPECT_FALSE(model_of(run, {}, kArmJson, kResultJson).arm_moving_min);
}

TEST(ModelsPage, GoesNewestFirstInPagesAndMarksTheCurrentApproval) {
  const std::vector<Approval> history{
      {.id = 1, .run_id = 4, .at = "a", .operator_name = "M. Curie", .hash = "h4", .valid_until = "u"},
      {.id = 2, .run_id = 5, .at = "b", .hash = "h5"},
      {.id = 3, .kind = ApprovalKind::kRolledBack, .run_id = 5, .at = "c", .hash = "h5"}};
  const ModelsDocument first = models_page(history, 2, {});
  ASSERT_THAT(first.models, SizeIs(2));
  EXPECT_EQ(first.models[0].kind, "rolled_back");
  EXPECT_EQ(first.models[0].hash, "h5");
  EXPECT_EQ(first.models[1].kind, "approved");
  EXPECT_FALSE(first.models[0].current || first.models[1].current);
  EXPECT_EQ(first.next_before, "2");
  const ModelsDocument second = models_page(history, 2, 2);
  ASSERT_THAT(second.models, SizeIs(1));
  EXPECT_TRUE(second.models[0].current);
  EXPECT_EQ(second.models[0].by, "M. Curie");
  EXPECT_EQ(second.models[0].valid_until, "u");
  EXPECT_FALSE(second.next_before);
  EXPECT_EQ(document_text(read_models(document_text(second))), document_text(second));
}

TEST(ModelsPage, TellsWhatUsesAModel) {
  const std::vector<Approval> history{
      {.id = 1, .run_id = 4, .at = "a", .hash = "h4"},
      {.id = 2, .kind = ApprovalKind::kApplied, .run_id = 4, .at = "b", .hash = "h4", .applied_to = "it"}};
  const ModelsDocument page = models_page(history, 2, {});
  EXPECT_EQ(page.models.at(0).kind, "applied");
  EXPECT_EQ(page.models.at(0).applied_to, "it");
  EXPECT_TRUE(page.models.at(1).current);
  EXPECT_FALSE(page.models.at(1).applied_to);
}

}  // namespace
}  // namespace cell
