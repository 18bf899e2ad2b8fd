#include "service/report/verification_report.hpp"

#include <gmock/gmock.h>

#include <nlohmann/json.hpp>
#include <sstream>

#include "service/base/digest.hpp"
#include "service/base/json_figures.hpp"
#include "tests/service/report/verified_run.hpp"

namespace cell {
namespace {

using ::testing::HasSubstr;

VerificationReport verified(const VerificationRecord& record) {
  return read_verification_report(verification_report_document(record));
}

TEST(VerificationReport, HasTheRunItsCalibrationAndTheResultAsStored) {
  const VerificationRecord record = proof_record();
  const Json report = Json::parse(verification_report_document(record));
  EXPECT_EQ(report.at("schema"), "touchcal/verification-report/1");
  EXPECT_EQ(report.at("kind"), "proof");
  EXPECT_EQ(report.at("cell"), "hall 3");
  EXPECT_EQ(report.at("run").at("operator"), "M. Curie");
  EXPECT_EQ(report.at("result"), Json::parse(record.own.result_json.value()));
  EXPECT_EQ(report.at("conditions"), Json::parse(kVerifiedConditions));
  const Json& calibration = report.at("calibration");
  EXPECT_EQ(calibration.at("id"), "7");
  EXPECT_EQ(calibration.at("ended_at"), "2026-01-31T08:25:30.250Z");
  EXPECT_EQ(calibration.at("verdict"), "accepted");
  EXPECT_EQ(calibration.at("raw_data_sha256"), sha256_hex(raw_data_text(record.calibration_touches)));
}

TEST(VerificationReport, EachTouchHasItsDistanceOrItsChange) {
  EXPECT_EQ(verified(proof_record()).touches.at(1).deviation_mm, -0.02);
  EXPECT_EQ(verified(check_record()).touches.at(1).deviation_mm, -0.03);
  EXPECT_EQ(verified(check_record()).touches.at(2).plane, 4);
  EXPECT_EQ(verified(qualification_record()).touches.at(0).deviation_mm, 0.0125);
  EXPECT_EQ(verified(qualification_record()).touches.at(2).deviation_mm, std::nullopt);
  ProofDocument fewer = made_proof();
  fewer.touches.pop_back();
  EXPECT_EQ(verified(proof_record(fewer)).touches.at(2).deviation_mm, std::nullopt);
}

TEST(VerificationReport, ACalibrationThatIsNoLongerStoredHasItsNumberOnly) {
  VerificationRecord record = check_record();
  record.calibration.reset();
  record.calibration_touches.clear();
  const Json calibration = Json::parse(verification_report_document(record)).at("calibration");
  EXPECT_EQ(calibration.at("id"), "7");
  for (const char* unknown : {"recipe", "started_at", "ended_at", "verdict", "raw_data_sha256"})
    EXPECT_TRUE(calibration.at(unknown).is_null()) << unknown;
}

TEST(VerificationReport, ARunWithoutAResultAndOneThatCannotBeReadHaveNoDeviation) {
  for (const std::optional<std::string>& result :
       {std::optional<std::string>(), std::optional<std::string>(R"({"schema":"touchcal/check/9"})"),
        std::optional<std::string>(R"({"schema":"touchcal/check/1"})")}) {
    VerificationRecord record = check_record();
    record.own.result_json = result;
    const Json report = Json::parse(verification_report_document(record));
    EXPECT_EQ(report.at("result"), result ? Json::parse(*result) : Json());
    ASSERT_EQ(report.at("touches").size(), 3U);
    for (const Json& touch : report.at("touches")) EXPECT_TRUE(touch.at("deviation_mm").is_null());
  }
}

TEST(VerificationReport, IsWrittenAsItWasRead) {
  for (const VerificationRecord& record : {proof_record(), check_record(), qualification_record()}) {
    const std::string text = verification_report_document(record);
    EXPECT_EQ(document_text(read_verification_report(text)), text);
  }
}

TEST(VerificationReport, TheRawDatasDigestIsThatOfTheTablesFirstNineColumns) {
  const VerificationReport report = verified(check_record());
  std::istringstream lines(verification_report_csv(report));
  std::string line, columns;
  std::getline(lines, line);
  EXPECT_THAT(line, ::testing::EndsWith("joint6_deg,deviation_mm,captured_at"));
  while (std::getline(lines, line)) {
    std::size_t end = 0;
    for (int i = 0; i < 9; ++i) end = line.find(',', end + 1);
    columns += line.substr(0, end) + "\n";
  }
  EXPECT_EQ(report.raw_data.sha256, sha256_hex(columns));
  EXPECT_THAT(verification_report_csv(report),
              HasSubstr("2,2,proof,1.500000,0.000000,0.000000,90.000000,-179.999999,-0.000002,-0.030000,"
                        "2026-02-03T08:16:00.000Z\n"));
}

}  // namespace
}  // namespace cell
