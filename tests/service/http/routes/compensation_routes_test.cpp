// POST /api/v1/compensate: targets in, joints for the calibrated arm of a run out.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "config/arm_writer.hpp"
#include "service/documents/compensation_view.hpp"
#include "service/documents/tool_document.hpp"
#include "service/run/compensated_targets.hpp"
#include "service/store/model_store.hpp"
#include "tests/service/http/routes/routes_bench.hpp"

namespace cell {
namespace {

using nlohmann::json;
using ::testing::HasSubstr;

const std::string kTwoTargets = R"({"schema":"touchcal/targets/1","tool":"stylus","targets":[
  {"name":"good","joints_deg":[20,30,60,10,50,-20]},{"name":"wrist","joints_deg":[20,30,60,10,0.5,-20]}]})";

class CompensationRoutes : public RoutesTest {
 protected:
  /// The arm of the cell with errors put in.
  static std::string arm_document_with(const calib::ErrorVector& errors) {
    Arm arm = edf().arm;
    arm.model = calib::apply(arm.model, errors);
    return arm_document(arm);
  }
  static calib::ErrorVector errors_of(double size) {
    calib::ErrorVector errors = calib::ErrorVector::Zero();
    for (const char* name : {"theta2", "theta3", "d3", "r7"})
      errors[calib::error_parameter_index(name).value()] = size;
    return errors;
  }
  std::int64_t run_with(const std::optional<std::string>& arm_json, bool is_accepted = true) {
    const std::int64_t run = cell_.store().begin_run({.recipe = "edf-25", .started_at = "start"});
    cell_.store().finish_run(run, {.outcome = RunOutcome::kComplete,
                                   .verdict = is_accepted ? Verdict::kAccepted : Verdict::kRejected,
                                   .ended_at = "end",
                                   .arm_json = arm_json});
    return run;
  }
  HttpResponse compensate(const std::string& query = "", const std::string& body = kTwoTargets) {
    return post("/api/v1/compensate" + query, body);
  }
};

TEST_F(CompensationRoutes, AnswerAsTheCommandDoesByTheNewestAcceptedArm) {
  run_with(arm_document_with(errors_of(0.002)));
  const std::string arm_json = arm_document_with(errors_of(0.001));
  run_with(arm_json);
  run_with(arm_document_with(errors_of(0.003)), false);
  const HttpResponse response = compensate();
  ASSERT_EQ(response.status, 200u) << response.body;
  const TargetsFile file = targets_from_json("t", kTwoTargets, kTargetsSizeMax);
  Arm arm = edf().arm;
  arm.model = calib::apply(arm.model, errors_of(0.001));
  const auto results = compensated(edf(), arm, tool_named(edf(), arm, "stylus", "t", ""), file.targets);
  const json wanted =
      json::parse(document_text(compensation_of(edf(), file.targets, results, arm_digest("a", arm_json))));
  const json answered = json::parse(response.body);
  EXPECT_EQ(answered.at("model"), wanted.at("model"));
  EXPECT_EQ(answered.at("targets").at(0).at("status"), "ok");
  for (std::size_t i = 0; i < 6; ++i) {
    EXPECT_NEAR(answered.at("targets").at(0).at("joints_deg").at(i).get<double>(),
                wanted.at("targets").at(0).at("joints_deg").at(i).get<double>(), 1e-9);
  }
  EXPECT_EQ(answered.at("targets").at(1), wanted.at("targets").at(1)) << "refused, and the answer is 200";
}

TEST_F(CompensationRoutes, TakeTheArmOfTheRunThatIsNamed) {
  const std::int64_t first = run_with(arm_document_with(errors_of(0.002)), false);
  run_with(arm_document_with(errors_of(0.001)));
  const auto moved_mm = [&](const std::string& query) {
    return json::parse(compensate(query).body).at("targets").at(0).at("moved_mm").get<double>();
  };
  EXPECT_NEAR(moved_mm("?run=" + std::to_string(first)) / moved_mm(""), 2.0, 0.05);
}

TEST_F(CompensationRoutes, TakeTheApprovedModelBeforeANewerRunUntilItsEnd) {
  const auto approve = [this](std::int64_t run, char hash_digit, const std::string& valid_until) {
    ModelStore(cell_.store().database())
        .approve({.run_id = run,
                  .at = "1970-01-01T00:00:00.000Z",
                  .operator_name = {},
                  .hash = std::string(64, hash_digit),
                  .valid_until = valid_until,
                  .document = R"({"arm":")" + edf().arm.name + R"("})",
                  .arm_json = cell_.store().arm_json(run).value()});
  };
  const auto answer = [this](const std::string& query) { return json::parse(compensate(query).body); };
  const std::int64_t first = run_with(arm_document_with(errors_of(0.001)));
  const json of_first = answer("").at("targets");
  approve(first, 'a', "1970-01-01T00:00:00.001Z");  // the clock stands at 1970
  const std::int64_t second = run_with(arm_document_with(errors_of(0.002)));
  EXPECT_EQ(answer("").at("model"), std::string(64, 'a'));
  EXPECT_EQ(answer("").at("targets"), of_first);
  EXPECT_NE(answer("?run=" + std::to_string(second)).at("targets"), of_first);
  approve(second, 'b', "1970-01-01T00:00:00.000Z");
  const json refused = problem(compensate());
  EXPECT_EQ(refused.at("status"), 409);
  EXPECT_THAT(refused.at("detail").get<std::string>(), HasSubstr("was valid until 1970-01-01T00:00:00.000Z"));
}

TEST_F(CompensationRoutes, RefuseAToolRunThatDoesNotCountForTheArm) {
  const std::int64_t first = run_with(arm_document_with(errors_of(0.001)));
  run_with(arm_document_with(errors_of(0.002)));
  const auto of_first = [&](RunKind kind, const std::string& result) {
    const std::int64_t run =
        cell_.store().begin_run({.kind = kind, .of_run = first, .recipe = "edf-25", .started_at = "start"});
    cell_.store().finish_run(run, {.outcome = RunOutcome::kComplete,
                                   .verdict = Verdict::kAccepted,
                                   .ended_at = "end",
                                   .result_json = result});
    return run;
  };
  const auto why_not = [this](std::int64_t run, const std::string& more = "") {
    const json refused = problem(compensate("?tool_run=" + std::to_string(run) + more));
    EXPECT_EQ(refused.at("status"), 409);
    return refused.at("detail").get<std::string>();
  };
  EXPECT_THAT(why_not(99), HasSubstr("run 99 has no result"));
  EXPECT_THAT(why_not(of_first(RunKind::kProof, document_text(ProofDocument()))),
              HasSubstr("is no result of touchcal tool"));
  ToolDocument found{
      .arm = edf().arm.name, .tool = "gripper", .of_run = "2"};  // as another daemon numbered it
  found.verdict = {.accepted = true, .reasons = {}};
  found.position_mm = {0.0, 0.0, 250.0};
  found.world_box_rms_mm = 0.05;
  const std::int64_t tool = of_first(RunKind::kTool, document_text(found));
  EXPECT_THAT(why_not(tool), HasSubstr("touch it again, with touchcal tool gripper --of 2"));
  EXPECT_THAT(why_not(tool, "&run=" + std::to_string(first)),
              HasSubstr("\"gripper\", which the cell does not have"));
}

TEST_F(CompensationRoutes, RefuseWhereThereIsNoArm) {
  EXPECT_EQ(problem(compensate()).at("status"), 409);
  EXPECT_EQ(problem(compensate("", "{}")).at("status"), 400) << "a wrong body is wrong without an arm too";
  const std::int64_t without = run_with(std::nullopt);
  EXPECT_THAT(problem(compensate()).at("detail").get<std::string>(), HasSubstr("has no calibrated arm"));
  EXPECT_EQ(problem(compensate("?run=" + std::to_string(without))).at("status"), 409);
  const json unknown = problem(compensate("?run=4711"));
  EXPECT_EQ(unknown.at("status"), 422);
  EXPECT_EQ(unknown.at("parameter"), "run");
  EXPECT_EQ(problem(compensate("?run=0")).at("status"), 400);
  Arm other = edf().arm;
  other.name = "tx60";
  const std::int64_t of_another = run_with(arm_document(other));
  EXPECT_THAT(problem(compensate("?run=" + std::to_string(of_another))).at("detail").get<std::string>(),
              HasSubstr("is \"tx60\" but the cell's arm is \"tx90\""));
}

TEST_F(CompensationRoutes, RefuseABodyWithItsPointer) {
  run_with(arm_document_with(errors_of(0.001)));
  for (
      const auto& [body, pointer] :
      {std::pair<std::string, std::string>{"{}", ""},
       {R"({"schema":"touchcal/targets/1","tool":"welder","targets":[{"name":"a","joints_deg":[1,2,3,4,5,6]}]})",
        "/tool"},
       {R"({"schema":"touchcal/targets/1","tool":"stylus","targets":[{"name":"a","joints_deg":[1,2,3,4,5]}]})",
        "/targets/0/joints_deg"},
       {R"({"schema":"touchcal/targets/1","tool":"stylus","targets":[{"name":"a","frame":"pallet",
         "position_mm":[1,2,3],"rotation_deg":[0,0,0],"near_joints_deg":[1,2,3,4,5,6]}]})",
        "/targets/0/frame"}}) {
    const json refused = problem(compensate("", body));
    EXPECT_EQ(refused.at("status"), 400) << body;
    EXPECT_EQ(refused.at("pointer"), pointer);
  }
}

TEST_F(CompensationRoutes, PutPointsOnStraightLines) {
  run_with(arm_document_with(errors_of(0.002)));
  const auto body = [](const std::string& more, const std::string& first = "start") {
    return R"({"schema":"touchcal/targets/2","tool":"stylus",)" + more + R"("targets":[
      {"name":")" +
           first + R"(","joints_deg":[20,30,60,10,50,-20]},
      {"name":"end","joints_deg":[-10,30,60,10,50,-20],"move":"line"}]})";
  };
  const HttpResponse response = compensate("", body(""));
  ASSERT_EQ(response.status, 200u) << response.body;
  const json answered = json::parse(response.body);
  EXPECT_EQ(answered.at("schema"), "touchcal/compensated/2");
  const json& targets = answered.at("targets");
  ASSERT_GT(targets.size(), 3U);
  EXPECT_EQ(targets.at(1).at("name"), "end.1");
  EXPECT_EQ(targets.at(1).at("inserted"), true);
  EXPECT_LE(targets.back().at("line_deviation_mm").get<double>(), 0.02);
  EXPECT_EQ(json::parse(compensate("", body(R"("line_max_mm":10,)")).body).at("targets").size(), 2U);
  EXPECT_EQ(problem(compensate("", body(R"("line_max_mm":-1,)"))).at("pointer"), "/line_max_mm");
  const json named = problem(compensate("", body("", "end.1")));
  EXPECT_EQ(named.at("status"), 400);
  EXPECT_EQ(named.at("pointer"), "/targets/1/name");
}

TEST_F(CompensationRoutes, NeedAnOperateToken) {
  HttpRequest request = made("POST", "/api/v1/compensate");
  request.content_type = "application/json";
  request.body = kTwoTargets;
  EXPECT_EQ(problem(send(request)).at("status"), 401);
  request.authorization = "Bearer " + kTokens.view;
  EXPECT_EQ(problem(send(request)).at("status"), 403);
}

}  // namespace
}  // namespace cell
