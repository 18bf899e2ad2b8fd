#include <gmock/gmock.h>

#include <nlohmann/json.hpp>

#include "config/arm_writer.hpp"
#include "service/documents/model_document.hpp"
#include "service/documents/run_document.hpp"
#include "service/documents/run_file.hpp"
#include "service/store/model_store.hpp"
#include "service/store/run_copy.hpp"
#include "tests/service/copied_run.hpp"
#include "tests/service/http/routes/routes_bench.hpp"

namespace cell {
namespace {

using ::testing::HasSubstr;

class RunFileRoutesTest : public RoutesTest {
 protected:
  static RunFile file_of(const std::string& cell) {
    RunFile file{
        .cell = cell, .exported_at = "2026-02-01T00:00:00.000Z", .copy = copied_run(), .model_json = {}};
    file.copy.arm_json = arm_document(edf().arm);
    return file;
  }
  HttpResponse import(const RunFile& file) { return post("/api/v1/runs/import", document_text(file)); }
  std::int64_t imported(const RunFile& file) {
    const HttpResponse answer = import(file);
    EXPECT_EQ(answer.status, 201U) << answer.body;
    return answer.status == 201 ? std::stoll(read_run(answer.body).id) : 0;
  }
  std::string refusal(const HttpResponse& response, unsigned status, const std::string& kind) {
    EXPECT_EQ(response.status, status) << response.body;
    const nlohmann::json document = problem(response);
    EXPECT_EQ(document.at("type"), "urn:touchcal:problem:" + kind);
    return document.at("detail");
  }
};

TEST_F(RunFileRoutesTest, AnImportedRunIsExportedAsItCame) {
  RunFile file = file_of("hall 3");
  const std::int64_t run = imported(file);
  const RunDocument told = read_run(get(path_of(run)).body);
  ASSERT_TRUE(told.imported_from);
  EXPECT_EQ(told.imported_from->cell, "hall 3");
  EXPECT_EQ(told.imported_from->run_id, "7");
  EXPECT_EQ(told.imported_from->imported_at, "1970-01-01T00:00:00.000Z");
  const HttpResponse again = get(path_of(run) + "/file");
  ASSERT_EQ(again.status, 200U) << again.body;
  RunFile back = read_run_file(again.body).file;
  EXPECT_EQ(back.copy.touches, file.copy.touches);
  back.cell = file.cell;
  back.exported_at = file.exported_at;
  back.copy.run.id = file.copy.run.id;
  EXPECT_EQ(document_text(back), document_text(file));
}

TEST_F(RunFileRoutesTest, ARunThatIsHereIsNotTakenTwice) {
  const std::int64_t run = imported(file_of("hall 3"));
  EXPECT_THAT(refusal(import(file_of("hall 3")), 409, "known-run"),
              HasSubstr("as run " + std::to_string(run)));
  EXPECT_NE(imported(file_of("hall 4")), run) << "another cell has a run 7 too";
}

TEST_F(RunFileRoutesTest, AProofComesAfterItsCalibration) {
  RunFile proof = file_of("hall 3");
  proof.copy.run.id = 9;
  proof.copy.run.kind = RunKind::kProof;
  proof.copy.run.of_run = 7;
  EXPECT_THAT(refusal(import(proof), 409, "state"), HasSubstr("import that run first"));
  const std::int64_t calibration = imported(file_of("hall 3"));
  EXPECT_EQ(cell_.store().run(imported(proof))->of_run, calibration);
}

TEST_F(RunFileRoutesTest, WhatIsDamagedOrNotOverIsRefused) {
  std::string text = document_text(file_of("hall 3"));
  text.replace(text.find("M. Curie"), 8, "P. Curie");
  EXPECT_THAT(refusal(post("/api/v1/runs/import", text), 400, "body"), HasSubstr("/sha256"));
  EXPECT_THAT(refusal(post("/api/v1/runs/import", "{}"), 400, "body"), HasSubstr("/schema"));
  EXPECT_THAT(refusal(get(path_of(stored_run()) + "/file"), 409, "state"), HasSubstr("is not over"));
  EXPECT_EQ(get("/api/v1/runs/999/file").status, 404U);
}

TEST_F(RunFileRoutesTest, OnlyARunOfACellOfThisNameCanBeApproved) {
  const std::int64_t other = imported(file_of("hall 3"));
  EXPECT_THAT(refusal(post(path_of(other) + "/approve", "{}"), 409, "not-approvable"),
              HasSubstr("is of the cell 'hall 3'"));
}

TEST_F(RunFileRoutesTest, TheModelThatWasApprovedTravelsWithItsRun) {
  RunFile file = file_of(edf().name);
  file.copy.result_json.reset();
  const std::int64_t run = imported(file);
  ModelStore models(cell_.store().database());
  ModelDocument model;
  model.run_id = std::to_string(run);
  model.approved_at = "1970-01-01T00:00:00.000Z";
  model.hash = model_hash(cell_.store().run(run).value(), cell_.store().touches(run), *file.copy.arm_json);
  models.approve({.run_id = run,
                  .at = model.approved_at,
                  .operator_name = {},
                  .hash = model.hash,
                  .valid_until = {},
                  .document = document_text(model),
                  .arm_json = *file.copy.arm_json});
  const RunFile told = read_run_file(get(path_of(run) + "/file").body).file;
  ASSERT_TRUE(told.model_json);
  EXPECT_EQ(read_model(*told.model_json).hash, model.hash);
}

}  // namespace
}  // namespace cell
