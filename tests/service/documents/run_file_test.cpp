#include "service/documents/run_file.hpp"

#include <gmock/gmock.h>

#include <functional>
#include <nlohmann/json.hpp>

#include "config/arm_writer.hpp"
#include "service/base/digest.hpp"
#include "service/documents/document_error.hpp"
#include "service/documents/model_document.hpp"
#include "tests/service/copied_run.hpp"
#include "tests/service/shipped_cell.hpp"

namespace cell {
namespace {

using Json = nlohmann::ordered_json;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

RunFile file_of_run() {
  RunFile file{
      .cell = "hall 3", .exported_at = "2026-02-01T00:00:00.000Z", .copy = copied_run(), .model_json = {}};
  file.copy.arm_json = arm_document(edf().arm);
  ModelDocument model;
  model.run_id = "7";
  model.approved_at = "2026-01-31T09:00:00.000Z";
  model.hash = model_hash(file.copy.run, file.copy.touches, *file.copy.arm_json);
  file.model_json = document_text(model);
  return file;
}

/// A change that whoever makes it also gives the digest of.
std::string forged(const std::function<void(Json&)>& change) {
  Json json = Json::parse(document_text(file_of_run()));
  change(json);
  json["sha256"] = "";
  json["sha256"] = sha256_hex(json.dump());
  return json.dump();
}

std::string refusal(const std::string& text) {
  try {
    (void)read_run_file(text);
  } catch (const DocumentError& error) {
    return error.what();
  }
  return "taken";
}

TEST(RunFile, IsReadAsItWasWritten) {
  const RunFile file = file_of_run();
  const std::string text = document_text(file);
  const ReadRunFile read = read_run_file(text);
  EXPECT_EQ(document_text(read.file), text);
  EXPECT_EQ(read.file.cell, "hall 3");
  EXPECT_EQ(read.file.copy.touches, file.copy.touches) << "to the last bit of a noise";
  EXPECT_EQ(read.file.copy.refused, file.copy.refused);
  EXPECT_EQ(read.file.copy.run.block_temperature, file.copy.run.block_temperature);
  EXPECT_EQ(read.file.copy.arm_json, file.copy.arm_json);
  EXPECT_EQ(read.file.model_json, file.model_json);
  EXPECT_EQ(read.sha256.size(), 64U);
}

TEST(RunFile, MayBeLaidOutInAnotherWay) {
  const std::string text = document_text(file_of_run());
  EXPECT_EQ(document_text(read_run_file(Json::parse(text).dump(2)).file), text);
}

TEST(RunFile, IsRefusedWhereAnythingInItWasChanged) {
  const std::string text = document_text(file_of_run());
  std::size_t refused = 0, changed = 0;
  for (std::size_t i = 0; i < text.size(); i += 7) {
    if (text[i] < '0' || text[i] > '8') continue;
    std::string other = text;
    ++other[i];
    ++changed;
    if (refusal(other) != "taken") ++refused;
  }
  EXPECT_GT(changed, 100U);
  EXPECT_EQ(refused, changed);
  EXPECT_THAT(refusal(text.substr(0, text.size() / 2)), HasSubstr("line"));
}

TEST(RunFile, IsTakenWithAnotherDigestOnlyWhereItHoldsWhatADaemonStores) {
  EXPECT_EQ(refusal(forged([](Json&) {})), "taken");
  const auto expect = [](const char* pointer, const std::function<void(Json&)>& change) {
    EXPECT_THAT(refusal(forged(change)), HasSubstr(pointer));
  };
  expect("/schema", [](Json& file) { file["schema"] = "touchcal/run-file/2"; });
  expect("/cell", [](Json& file) { file["cell"] = ""; });
  expect("/exported_at", [](Json& file) { file["exported_at"] = "yesterday"; });
  expect("/run/id", [](Json& file) { file["run"]["id"] = "7 or so"; });
  expect("/run/kind", [](Json& file) { file["run"]["kind"] = "inspection"; });
  expect("/run/of_run", [](Json& file) { file["run"]["of_run"] = "3"; });
  expect("/run/of_run", [](Json& file) { file["run"]["kind"] = "proof"; });
  expect("/run/outcome", [](Json& file) { file["run"]["outcome"] = "running"; });
  expect("/run/verdict", [](Json& file) { file["run"]["verdict"] = "splendid"; });
  expect("/run/touches_total", [](Json& file) { file["run"]["touches_total"] = -1; });
  expect("/run/started_at", [](Json& file) { file["run"]["started_at"] = "2026-01-31"; });
  expect("/run/conditions", [](Json& file) { file["run"]["conditions"] = "[1"; });
  expect("/touches/1/number", [](Json& file) { file["touches"][1]["number"] = 1; });
  expect("/touches/0/number", [](Json& file) { file["touches"][0]["number"] = 0; });
  expect("/touches/0/plane", [](Json& file) { file["touches"][0]["plane"] = 65; });
  expect("/touches/0/session", [](Json& file) { file["touches"][0]["session"] = -1; });
  expect("/touches/0/contact/source",
         [](Json& file) { file["touches"][0]["contact"]["source"] = "guessed"; });
  expect("/touches/0/contact/joints_microdeg",
         [](Json& file) { file["touches"][0]["contact"]["joints_microdeg"].push_back(1); });
  expect("/superseded_touches/1/touch/captured_at",
         [](Json& file) { file["superseded_touches"][1]["touch"]["captured_at"] = ""; });
  expect("/reference_touches/1/number", [](Json& file) { file["reference_touches"][1]["number"] = 1; });
  expect("/plan_changes/0", [](Json& file) { file["plan_changes"][0]["kind"] = "shuffle"; });
  expect("/refused_contacts", [](Json& file) {
    for (int i = 0; i < kRefusedKept; ++i) file["refused_contacts"].push_back(file["refused_contacts"][0]);
  });
  expect("/result", [](Json& file) { file["result"] = std::string(100, '[') + std::string(100, ']'); });
  expect("/plan", [](Json& file) { file["plan"] = "{}"; });
  expect("/arm", [](Json& file) { file["arm"] = R"({"name":"tx90"})"; });
  expect("/model", [](Json& file) { file["touches"][0]["contact"]["joints_microdeg"][0] = 2; });
}

TEST(RunFile, TellsWhatOtherTextsAre) {
  EXPECT_THAT(refusal("{}"), AllOf(HasSubstr("/schema"), HasSubstr("touchcal export-run")));
  EXPECT_THAT(refusal("[]"), HasSubstr("/schema"));
  EXPECT_NE(refusal(""), "taken");
  EXPECT_NE(refusal(std::string(kRunFileBytesMax + 1, ' ')), "taken");
}

}  // namespace
}  // namespace cell
