#include <SQLiteCpp/SQLiteCpp.h>
#include <gmock/gmock.h>

#include <boost/asio/co_spawn.hpp>
#include <nlohmann/json.hpp>

#include "config/arm_writer.hpp"
#include "service/documents/model_document.hpp"
#include "service/http/routes/api.hpp"
#include "service/store/model_store.hpp"
#include "tests/service/http/routes/routes_bench.hpp"

namespace cell {
namespace {

using nlohmann::json;
using ::testing::HasSubstr;
using ::testing::SizeIs;

class ModelRoutesTest : public RoutesTest {
 protected:
  static std::string arm_named(const std::string& name) { return R"({"name":")" + name + R"("})"; }

  /// A run of one touch that ended.
  std::int64_t ended_run(Verdict verdict = Verdict::kAccepted, const std::string& arm = edf().arm.name,
                         RunOutcome outcome = RunOutcome::kComplete) {
    const std::int64_t run = stored_run();
    cell_.store().append_touch(run, {.number = 1, .plane = 1, .captured_at = "t"});
    cell_.store().finish_run(run, {.outcome = outcome,
                                   .verdict = verdict,
                                   .ended_at = "end",
                                   .result_json = kResultText,
                                   .arm_json = arm_named(arm)});
    return run;
  }
  HttpResponse approve(std::int64_t run, const std::string& body = "{}") {
    return post(path_of(run) + "/approve", body);
  }
  std::string refusal(const HttpResponse& response, const std::string& kind) {
    EXPECT_EQ(response.status, 409u) << response.body;
    const json document = problem(response);
    EXPECT_EQ(document.at("type"), "urn:touchcal:problem:" + kind);
    return document.at("detail");
  }
  HttpResponse current() { return get("/api/v1/models/current"); }
  std::string current_run() { return read_model(current().body).run_id; }
  std::size_t row_count() { return ModelStore(cell_.store().database()).history().size(); }

  static constexpr const char* kResultText =
      R"({"tip_uncertainty":{"expanded":{"box_max_mm":0.2}},"parameters":[],"nongeometric_parameters":[]})";
};

TEST_F(ModelRoutesTest, AnAcceptedRunBecomesTheCellsModelByAPersonsWord) {
  EXPECT_THAT(refusal(current(), "no-model"), HasSubstr("touchcal approve RUN"));
  const std::int64_t run = ended_run();
  const HttpResponse answer = approve(run, R"({"operator":"M. Curie","valid_days":2})");
  ASSERT_EQ(answer.status, 200u) << answer.body;
  const ModelDocument model = read_model(answer.body);
  EXPECT_EQ(model.run_id, std::to_string(run));
  EXPECT_EQ(model.hash, model_hash(cell_.store().run(run).value(), cell_.store().touches(run),
                                   arm_named(edf().arm.name)));
  EXPECT_EQ(model.approved_by, "M. Curie");
  EXPECT_EQ(model.approved_at, "1970-01-01T00:00:00.000Z");
  EXPECT_EQ(model.valid_until, "1970-01-03T00:00:00.000Z");
  EXPECT_FALSE(model.proof_run_id);
  EXPECT_EQ(current().body, answer.body);
  const ModelsDocument listed = read_models(get("/api/v1/models").body);
  ASSERT_THAT(listed.models, SizeIs(1));
  EXPECT_TRUE(listed.models[0].current);
  EXPECT_EQ(listed.models[0].hash, model.hash);
}

TEST_F(ModelRoutesTest, TheArmIsTheOneThatWasStoredAlsoWhenTheRunGetsAnother) {
  const std::int64_t run = ended_run();
  const std::string model = approve(run).body;
  cell_.store().set_result_json(run, kResultText);
  EXPECT_EQ(current().body, model);
}

TEST_F(ModelRoutesTest, TheArmOfAnApprovalIsToldByItsId) {
  const std::string arm_json = arm_document(edf().arm);
  const std::int64_t run = stored_run();
  cell_.store().finish_run(run, {.outcome = RunOutcome::kComplete,
                                 .verdict = Verdict::kAccepted,
                                 .ended_at = "end",
                                 .result_json = kResultText,
                                 .arm_json = arm_json});
  approve(ended_run());
  approve(run);
  post("/api/v1/models/rollback", "{}");
  EXPECT_EQ(get("/api/v1/models/2/arm").body, arm_json);
  for (const char* id : {"3", "4", "current", "-1"})
    EXPECT_EQ(problem(get(std::string("/api/v1/models/") + id + "/arm")).at("status"), 404) << id;
}

TEST_F(ModelRoutesTest, ApprovingTheCurrentModelAgainGivesTheSameAnswerAndWritesNothing) {
  const std::int64_t run = ended_run();
  const std::string first = approve(run, R"({"operator":"M. Curie"})").body;
  EXPECT_EQ(approve(run, R"({"operator":"another","valid_days":1})").body, first);
  EXPECT_EQ(approve(run, "").body, first);
  EXPECT_EQ(row_count(), 1u);
}

TEST_F(ModelRoutesTest, ARollbackTakesTheOneBeforeAndWhatWasTakenBackIsApprovedAnew) {
  const std::int64_t first = ended_run(), second = ended_run();
  EXPECT_THAT(refusal(post("/api/v1/models/rollback", "{}"), "no-model"), HasSubstr("no model is approved"));
  approve(first);
  EXPECT_THAT(refusal(post("/api/v1/models/rollback", "{}"), "no-model"),
              HasSubstr("no model before that of run " + std::to_string(first)));
  approve(second);
  EXPECT_EQ(current_run(), std::to_string(second));
  const HttpResponse back = post("/api/v1/models/rollback", R"({"operator":"P. Langevin"})");
  ASSERT_EQ(back.status, 200u) << back.body;
  EXPECT_EQ(read_model(back.body).run_id, std::to_string(first));
  EXPECT_EQ(current().body, back.body);
  EXPECT_EQ(read_models(get("/api/v1/models?limit=1").body).models.at(0).by, "P. Langevin");
  approve(second);
  EXPECT_EQ(current_run(), std::to_string(second));
  EXPECT_EQ(row_count(), 4u);
}

TEST_F(ModelRoutesTest, WhatUsesAModelIsNotedAndTheModelStaysWhatItIs) {
  const std::string applied = "/api/v1/models/applied";
  EXPECT_THAT(refusal(post(applied, R"({"to":"pick.dtx"})"), "no-model"), HasSubstr("no model is approved"));
  const std::int64_t first = ended_run(), second = ended_run();
  approve(first);
  approve(second);
  const std::string model = current().body;
  const HttpResponse noted = post(applied, R"({"to":"pick.dtx on the robot","operator":"M. Curie"})");
  ASSERT_EQ(noted.status, 200u) << noted.body;
  const ApprovalRow row = read_models(noted.body).models.at(0);
  EXPECT_EQ(row.kind, "applied");
  EXPECT_EQ(row.applied_to, "pick.dtx on the robot");
  EXPECT_EQ(row.by, "M. Curie");
  EXPECT_EQ(row.run_id, std::to_string(second));
  EXPECT_FALSE(row.current);
  EXPECT_EQ(current().body, model);
  const std::string of_first = read_models(noted.body).models.at(2).hash;
  for (const std::string& named : {of_first, of_first.substr(0, 12)})
    EXPECT_EQ(read_models(post(applied, json{{"to", "it"}, {"hash", named}}.dump()).body).models.at(0).hash,
              of_first);
  EXPECT_THAT(refusal(post(applied, json{{"to", "it"}, {"hash", of_first.substr(1)}}.dump()), "no-model"),
              HasSubstr("no approval has the hash"));
  EXPECT_EQ(problem(post(applied, json{{"to", "it"}, {"hash", of_first.substr(0, 11)}}.dump())).at("pointer"),
            "/hash");
  EXPECT_EQ(problem(get("/api/v1/models/3/arm")).at("status"), 404) << "it is no approval";
  for (const char* body : {"", "{}", R"({"to":""})", R"({"to":"a\nb"})", R"({"to":1})"})
    EXPECT_EQ(problem(post(applied, body)).at("pointer"), "/to") << body;
  EXPECT_EQ(problem(post(applied, json{{"to", std::string(201, 'a')}}.dump())).at("pointer"), "/to");
  EXPECT_EQ(problem(post(applied, R"({"to":"it","hash":1})")).at("pointer"), "/hash");
  EXPECT_EQ(problem(post(applied, R"({"to":"it","valid_days":1})")).at("pointer"), "/valid_days");
  EXPECT_EQ(row_count(), 5u);
}

TEST_F(ModelRoutesTest, OnlyARunThatIsCompleteAndAcceptedCanBeApproved) {
  EXPECT_THAT(refusal(approve(stored_run()), "not-approvable"), HasSubstr("is not over"));
  EXPECT_THAT(refusal(approve(ended_run(Verdict::kRejected)), "not-approvable"),
              HasSubstr("'complete' and its verdict 'rejected'"));
  EXPECT_THAT(refusal(approve(ended_run(Verdict::kAccepted, "tx90", RunOutcome::kStopped)), "not-approvable"),
              HasSubstr("'stopped'"));
  const std::int64_t bare = stored_run();
  cell_.store().finish_run(
      bare, {.outcome = RunOutcome::kComplete, .verdict = Verdict::kAccepted, .result_json = kResultText});
  EXPECT_THAT(refusal(approve(bare), "not-approvable"), HasSubstr("no calibrated arm was stored"));
  EXPECT_EQ(approve(999).status, 404u);
  EXPECT_EQ(post("/api/v1/runs/one/approve", "{}").status, 404u);
  EXPECT_EQ(row_count(), 0u);
}

TEST_F(ModelRoutesTest, AModelOfAnotherArmIsRefusedWithASentence) {
  EXPECT_THAT(refusal(approve(ended_run(Verdict::kAccepted, "other")), "other-arm"),
              HasSubstr("of the arm 'other', and this cell has the arm '" + edf().arm.name + "' now"));
  EXPECT_EQ(row_count(), 0u);
  // The cell had another arm when it was approved.
  ModelStore models(cell_.store().database());
  models.approve({.run_id = 1,
                  .at = "t",
                  .hash = "h",
                  .document = R"({"arm":"other"})",
                  .arm_json = arm_named("other")});
  EXPECT_THAT(refusal(current(), "other-arm"), HasSubstr("the arm 'other'"));
  approve(ended_run());
  EXPECT_EQ(current().status, 200u);
  EXPECT_THAT(refusal(post("/api/v1/models/rollback", "{}"), "other-arm"), HasSubstr("the arm 'other'"));
  EXPECT_EQ(row_count(), 2u);
}

TEST_F(ModelRoutesTest, ABodyIsBoundedAndRefusedByItsPlace) {
  const std::int64_t run = ended_run();
  const std::string long_name(101, 'x');
  const std::vector<std::pair<std::string, std::string>> bodies{
      {R"({"operator":""})", "/operator"},
      {R"({"operator":7})", "/operator"},
      {R"({"operator":"a\u0007b"})", "/operator"},
      {R"({"operator":")" + long_name + R"("})", "/operator"},
      {R"({"valid_days":0})", "/valid_days"},
      {R"({"valid_days":36501})", "/valid_days"},
      {R"({"valid_days":1.5})", "/valid_days"},
      {R"({"days":1})", "/days"},
      {"[]", ""},
      {"{", ""}};
  for (const auto& [body, pointer] : bodies) {
    const HttpResponse refused = approve(run, body);
    EXPECT_EQ(refused.status, 400u) << body;
    EXPECT_EQ(problem(refused).value("pointer", "none"), pointer) << body;
  }
  EXPECT_EQ(problem(post("/api/v1/models/rollback", R"({"valid_days":1})")).at("pointer"), "/valid_days");
  EXPECT_EQ(row_count(), 0u);
}

TEST_F(ModelRoutesTest, AChangedByteOfTheRowIsAnsweredAsDamage) {
  const std::int64_t run = ended_run();
  approve(run);
  cell_.store().database()->exec("UPDATE models SET arm = replace(arm, 'tx90', 'tx91')");
  const HttpResponse refused = current();
  EXPECT_EQ(refused.status, 503u);
  EXPECT_EQ(problem(refused).at("type"), "urn:touchcal:problem:damaged");
  EXPECT_THAT(problem(refused).at("detail").get<std::string>(), HasSubstr("table models"));
  EXPECT_EQ(get("/api/v1/models").status, 503u);
  EXPECT_EQ(approve(run).status, 503u);
}

TEST_F(ModelRoutesTest, APageLeadsToTheNext) {
  const std::int64_t first = ended_run(), second = ended_run();
  approve(first);
  approve(second);
  const ModelsDocument newest = read_models(get("/api/v1/models?limit=1").body);
  EXPECT_EQ(newest.models.at(0).run_id, std::to_string(second));
  const ModelsDocument next =
      read_models(get("/api/v1/models?limit=1&before=" + newest.next_before.value()).body);
  EXPECT_EQ(next.models.at(0).run_id, std::to_string(first));
  EXPECT_FALSE(next.next_before);
  for (const char* query : {"limit=0", "limit=501", "before=x"})
    EXPECT_EQ(get(std::string("/api/v1/models?") + query).status, 400u) << query;
}

/// The same over the API, which has the audit, the keys and the threads.
class ModelApiTest : public ModelRoutesTest {
 protected:
  HttpResponse answered(const std::string& target, const std::string& body, const std::string& token,
                        const std::optional<std::string>& key = {}) {
    HttpRequest request = made("POST", target);
    request.from_loopback = true;
    request.remote = "127.0.0.1";
    if (!token.empty()) request.authorization = "Bearer " + token;
    request.content_type = "application/json";
    request.body = body;
    request.idempotency_key = key;
    std::optional<HttpResponse> response;
    boost::asio::co_spawn(cell_.context(), api_.answer(request),
                          [&](const std::exception_ptr& failure, HttpResponse answer) {
                            EXPECT_FALSE(failure);
                            response = std::move(answer);
                          });
    cell_.context().restart();
    cell_.context().run();
    return response.value_or(HttpResponse{.status = 0});
  }

  Api api_{cell_.context().get_executor(), cell_.operation(), kTokens};
};

TEST_F(ModelApiTest, ItNeedsTheOperateTokenAndTheAuditNamesWhoApproved) {
  const std::string target = path_of(ended_run()) + "/approve", body = R"({"operator":"M. Curie"})";
  EXPECT_EQ(answered(target, body, "").status, 401u);
  EXPECT_EQ(answered(target, body, kTokens.view).status, 403u);
  EXPECT_EQ(answered("/api/v1/models/rollback", body, kTokens.view).status, 403u);
  EXPECT_EQ(row_count(), 0u);
  EXPECT_EQ(answered(target, body, kTokens.operate).status, 200u);
  const auto rows = api_.services().audit.page(2);
  ASSERT_THAT(rows, SizeIs(2));
  for (const AuditEntry& row : rows) {
    EXPECT_EQ(row.action, "POST " + target);
    EXPECT_EQ(row.operator_name, "M. Curie");
  }
  EXPECT_EQ(rows[0].outcome, "200");
  EXPECT_EQ(rows[1].outcome, "asked");
}

TEST_F(ModelApiTest, ARepeatedKeyIsAnsweredAsTheFirstTimeAndDoesNotRollBackTwice) {
  for (int i = 0; i < 3; ++i) approve(ended_run());
  const std::string first = answered("/api/v1/models/rollback", "{}", kTokens.operate, "once").body;
  EXPECT_EQ(answered("/api/v1/models/rollback", "{}", kTokens.operate, "once").body, first);
  EXPECT_EQ(current().body, first);
  EXPECT_NE(answered("/api/v1/models/rollback", "{}", kTokens.operate, "twice").body, first);
}

}  // namespace
}  // namespace cell
