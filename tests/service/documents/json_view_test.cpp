#include "service/documents/json_view.hpp"

#include <gmock/gmock.h>

#include <limits>
#include <nlohmann/json.hpp>

#include "calib_core/geometry/units.hpp"
#include "service/run/run.hpp"
#include "service/run/touch_command.hpp"
#include "tests/service/document_shape.hpp"
#include "tests/service/shipped_cell.hpp"

namespace cell {
namespace {

using nlohmann::json;

const Shape kQuietStatus{{"state", "string"},
                         {"waiting_for", "null"},
                         {"run_id", "null"},
                         {"recipe", "null"},
                         {"touches_done", "number"},
                         {"touches_total", "null"},
                         {"plane", "null"},
                         {"block_place", "null"},
                         {"identifiable_count", "null"},
                         {"condition_number", "null"},
                         {"predicted_tip_rms_mm", "null"},
                         {"more_would_bring", "null"},
                         {"eta_s", "null"},
                         {"verdict", "string"},
                         {"controller_connected", "boolean"},
                         {"controller_powered", "null"},
                         {"controller_mode", "null"},
                         {"controller_estop", "null"},
                         {"controller_cell_closed", "null"},
                         {"controller_touch_tested", "null"},
                         {"controller_permit", "null"},
                         {"probe", "null"},
                         {"retract_due", "null"},
                         {"by_hand", "null"},
                         {"by_hand_step", "null"},
                         {"by_hand_plane", "null"},
                         {"by_hand_index", "null"},
                         {"by_hand_total", "null"},
                         {"by_hand_words", "null"},
                         {"by_hand_problem", "null"},
                         {"by_hand_joints_deg", "null"},
                         {"fault_code", "null"},
                         {"fault_message", "null"},
                         {"fault_robot_action", "null"},
                         {"fault_next_step", "null"},
                         {"warning_code", "null"},
                         {"warning_message", "null"},
                         {"reference_drift_mm", "null"},
                         {"last_accepted_run_id", "null"},
                         {"last_accepted_at", "null"},
                         {"data_age_ms", "null"},
                         {"mqtt_behind", "null"},
                         {"mqtt_trouble", "null"},
                         {"archive_behind", "null"},
                         {"archive_trouble", "null"},
                         {"sequence", "number"},
                         {"instance_id", "string"},
                         {"since", "string"}};

TEST(StatusDocument, HasTheContractsFieldsWhenNothingIsKnown) {
  EXPECT_EQ(shape_of(json::parse(status_document({}))), kQuietStatus);
}

TEST(StatusDocument, HasTheSameFieldsWhenAllIsKnown) {
  Status busy;
  busy.state = State::kHeld;
  busy.waiting_for = "confirmation";
  busy.run_id = 7;
  busy.recipe = "edf-25";
  busy.touches_done = 3;
  busy.touches_total = 140;
  busy.plane = 2;
  busy.block_place = "stand";
  busy.identifiable_count = 3;
  busy.condition_number = 12.5;
  busy.predicted_tip_rms_m = 6e-5;
  busy.touch_benefit = "8 more on plane 5: 0.21 to 0.15 mm";
  busy.eta_s = 30.0;
  busy.controller.connected = true;
  busy.controller.powered = true;
  busy.controller.mode = "remote";
  busy.controller.emergency_stop = false;
  busy.controller.cell_closed = true;
  busy.controller.touch_tested = true;
  busy.controller.permit = "awaited";
  busy.controller.probe = "free";
  busy.controller.retract_due = false;
  busy.by_hand = HandGuide{.activity = HandActivity::kGuided,
                           .plane = 3,
                           .index = 1,
                           .total = 6,
                           .words = "touch plane 3",
                           .problem = "too fast",
                           .about_joints = calib::JointVector::Zero()};
  busy.fault = Fault{FaultCode::kNoContact, ""};
  busy.warning = Fault{FaultCode::kTouchOutlier, "touch 3"};
  busy.reference_drift_m = 2e-5;
  busy.last_accepted_run_id = 6;
  busy.last_accepted_at = "then";
  busy.data_age_ms = 12;
  busy.sinks = {{.sink = "mqtt", .behind = 3, .trouble = "no broker"},
                {.sink = "archive", .behind = 4, .trouble = "no archive"}};
  const json document = json::parse(status_document(busy));
  for (const auto& [name, value] : document.items()) {
    EXPECT_TRUE(kQuietStatus.contains(name)) << name;
    EXPECT_FALSE(value.is_null()) << name;
  }
  EXPECT_EQ(document.size(), kQuietStatus.size());
  EXPECT_EQ(document.at("state"), "HELD");
  EXPECT_NEAR(document.at("predicted_tip_rms_mm").get<double>(), 0.06, 1e-12);
  EXPECT_EQ(document.at("run_id"), "7") << "ids are text: no client counts with them";
  EXPECT_EQ(document.at("fault_code"), "no_contact");
  EXPECT_EQ(document.at("controller_estop"), false);
  EXPECT_EQ(document.at("mqtt_behind"), 3);
  EXPECT_EQ(document.at("archive_trouble"), "no archive");
}

TEST(StatusDocument, AFigureThatIsNoNumberIsNull) {
  const Status status{.condition_number = std::numeric_limits<double>::infinity(),
                      .eta_s = std::numeric_limits<double>::quiet_NaN()};
  const json document = json::parse(status_document(status));
  EXPECT_TRUE(document.at("condition_number").is_null());
  EXPECT_TRUE(document.at("eta_s").is_null());
}

TEST(StatusDocument, BytesThatAreNoTextAreShownAsFarAsTheyAre) {
  const Status status{.fault = Fault{FaultCode::kProtocolError, "sent \xff\xfe and \x01"}};
  const json document = json::parse(status_document(status));
  EXPECT_THAT(document.at("fault_message").get<std::string>(), ::testing::HasSubstr("sent \xEF\xBF\xBD"));
}

TEST(RunsDocument, HasEachRunsFieldsAndWhereTheNextPageBegins) {
  const StoredRun running{.id = 2,
                          .recipe = "edf-25",
                          .started_at = "start",
                          .outcome = RunOutcome::kRunning,
                          .verdict = Verdict::kNone};
  const json page = json::parse(runs_document({.runs = {running}, .damaged = {}, .next_before = 2}));
  EXPECT_EQ(page.at("next_before"), "2");
  ASSERT_EQ(page.at("runs").size(), 1u);
  json alone = json::parse(run_document(running));
  EXPECT_TRUE(alone.at("conditions").is_null()) << "an older daemon kept none";
  EXPECT_TRUE(alone.at("imported_from").is_null()) << "it is of this daemon";
  alone.erase("conditions");
  alone.erase("imported_from");
  EXPECT_EQ(page.at("runs")[0], alone);
  EXPECT_EQ(shape_of(page.at("runs")[0]), (Shape{{"id", "string"},
                                                 {"kind", "string"},
                                                 {"of_run", "null"},
                                                 {"recipe", "string"},
                                                 {"touching", "string"},
                                                 {"outcome", "string"},
                                                 {"verdict", "string"},
                                                 {"touches_done", "number"},
                                                 {"touches_total", "null"},
                                                 {"started_at", "string"},
                                                 {"ended_at", "null"},
                                                 {"fault_code", "null"},
                                                 {"fault_message", "null"}}));
  const json last = json::parse(runs_document({}));
  EXPECT_EQ(last, (json{{"runs", json::array()}, {"damaged", json::array()}, {"next_before", nullptr}}));
}

TEST(TouchesDocument, IsWhatIdentifyReadsBackToTheLastStep) {
  const std::vector<StoredTouch> stored{
      {.number = 1, .plane = 1, .joints = {-42469929, 70229417, 43225787, 52719402, 128430178, -91254213}},
      {.number = 2,
       .plane = 4,
       .role = calib::TouchRole::kHeldOut,
       .joints = {1, -1, 7, 123456789, 0, -270000000}},
      {.number = 3, .plane = 2, .role = calib::TouchRole::kProof, .noise_um = 61.1},
      {.number = 4, .plane = 2, .noise_um = calib::um_from_metres(edf().touch_noise_m)}};
  const std::string document = touches_document(edf(), stored, {});
  const TouchesFile read = touches_from_json("document", document, document.size(), edf());
  ASSERT_EQ(read.touches.size(), stored.size());
  for (std::size_t i = 0; i < stored.size(); ++i) {
    EXPECT_EQ(read.touches[i].face + 1, stored[i].plane);
    EXPECT_EQ(read.touches[i].role, stored[i].role);
    EXPECT_EQ(to_wire(read.touches[i].joints), stored[i].joints) << i;
    if (i == 3) continue;  // the declared noise, which is not written
    EXPECT_EQ(read.touches[i].deviation_m, to_touch(stored[i]).deviation_m) << i;
  }
  const json touches = json::parse(document).at("touches");
  EXPECT_EQ(touches[2].at("noise_um"), 61.1);
  for (const std::size_t i : {0u, 1u, 3u}) EXPECT_FALSE(touches[i].contains("noise_um")) << "the cell's";
  EXPECT_EQ(json::parse(document).at("schema"), kSecondTouchesSchema);
  const std::vector<StoredTouch> without(stored.begin(), stored.begin() + 2);
  EXPECT_EQ(json::parse(touches_document(edf(), without, {})).at("schema"), kFirstTouchesSchema);
}

TEST(TouchesDocument, HasTheNoiseOfAQualificationToTheLastBitHoweverOftenItIsWritten) {
  std::optional<calib::TouchNoise> noise{{19.123456e-6, 9.0}};
  const auto read_back = [&] {
    const std::string document = touches_document(edf(), {}, {}, noise);
    EXPECT_EQ(json::parse(document).at("schema"), kTouchesSchema);
    return touches_from_json("document", document, document.size(), edf()).repeats.qualified;
  };
  noise = read_back();
  const double once_m = noise.value().std_m;
  EXPECT_EQ(read_back().value().std_m, once_m);
  EXPECT_EQ(read_back().value().degrees_of_freedom, 9.0);
}

}  // namespace
}  // namespace cell
