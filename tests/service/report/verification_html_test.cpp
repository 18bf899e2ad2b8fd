#include "service/report/verification_html.hpp"

#include <gmock/gmock.h>

#include "service/base/digest.hpp"
#include "tests/service/report/markup.hpp"
#include "tests/service/report/verified_run.hpp"

namespace cell {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

std::string verified_page(const VerificationRecord& record) {
  return verification_html(read_verification_report(verification_report_document(record)),
                           "2026-02-04T00:00:00.000Z");
}

std::string verified_front(const VerificationRecord& record) {
  const std::string page = verified_page(record);
  return page.substr(page.find("<body>"), page.find("</section>") - page.find("<body>"));
}

TEST(VerificationHtml, TheFirstPageHasWhatIsSignedWithTheVerdictFirst) {
  const VerificationRecord record = proof_record();
  const std::string number = "20260203-9-" + sha256_hex(raw_data_text(record.own.touches)).substr(0, 8);
  const std::string front = verified_front(record);
  for (const std::string& told :
       {"<h1>Proof report " + number + "</h1>", std::string("Verdict: proved"),
        std::string("The calibrated arm is right at this place"),
        std::string("<td>date of issue</td><td>2026-02-04T00:00:00.000Z</td>"),
        std::string("<td>cell</td><td>hall 3</td>"), std::string("tx90; F09-1"), std::string("cube; B-3"),
        std::string("lp2; unknown"), std::string("<td>M. Curie</td>"), std::string("Proved by"),
        std::string("Approved by"),
        std::string("volumes that are far both from the place of the calibration")})
    EXPECT_THAT(front, HasSubstr(told));
  EXPECT_LT(front.find("Verdict:"), front.find("date of issue"));
  EXPECT_THAT(verified_page(record), HasSubstr("content: \"Proof report " + number + "\""))
      << "the head of each page";
  EXPECT_THAT(verified_front(check_record()), AllOf(HasSubstr("<h1>Check report "), HasSubstr("Checked by")));
}

TEST(VerificationHtml, TheCalibrationIsNamedByItsDateAndItsReport) {
  VerificationRecord record = proof_record();
  const std::string digest = sha256_hex(raw_data_text(record.calibration_touches));
  EXPECT_THAT(
      verified_front(record),
      HasSubstr("<td>calibration that is proved</td><td>run 7 of 2026-01-31T08:25:30.250Z, recipe best, "
                "accepted, report 20260131-7-" +
                digest.substr(0, 8) + "</td>"));
  record.calibration.reset();
  EXPECT_THAT(verified_front(record), HasSubstr("run 7, which is no longer stored: its date is unknown"));
}

TEST(VerificationHtml, AQualificationTellsEachFigureBesideItsLimitAndNeedsNoCalibration) {
  VerificationRecord record = qualification_record();
  const std::string page = verified_page(record);
  for (const char* told :
       {"<h1>Qualification report ", "Verdict: not qualified", "the ball runs out by more than is allowed",
        "<td>0.6000 mm ± 0.0250 (k = 2)</td><td>at most 0.5 mm</td><td>fail</td>",
        "<td>0.25</td><td>at least 0.001</td><td>pass</td>",
        "<td>0.0125 mm ± 0.0400 (k = 2)</td><td>no limit in the cell&#39;s file</td><td>pass</td>",
        "<td>3 and 5</td><td>150.0000</td><td>-0.0125</td><td>0.0200</td><td>0.625</td>",
        "Deviations of the touches"})
    EXPECT_THAT(page, HasSubstr(told));
  record.own.run.of_run.reset();
  record.calibration.reset();
  EXPECT_THAT(
      verified_page(record),
      HasSubstr("<td>calibration that the stylus and the lengths are held against</td><td>none</td>"));
}

TEST(VerificationHtml, AToolTellsWhereItsTipIsBesideItsDrawing) {
  const std::string page = verified_page(verified_run(RunKind::kTool, document_text(made_tool())));
  for (const char* told :
       {"<h1>Tool report ", "Verdict: not found", "the touches contradict each other",
        "<td>0.0625 mm</td><td>no limit in the cell&#39;s file</td><td>pass</td>",
        "<td>0.0025</td><td>at least 0.01</td><td>fail</td>", "<td>0.1250, -0.2500, 250.5000 mm</td>",
        "<td>0.0000, 0.0000, 250.0000 mm</td>", "<td>0.5728 mm</td>", "Distances from the block"})
    EXPECT_THAT(page, HasSubstr(told));
}

TEST(VerificationHtml, AProofsFiguresStandBesideTheirLimits) {
  const std::string page = verified_page(proof_record());
  for (const char* row :
       {"<td>0.0125 mm</td><td>at most 0.03 mm</td><td>within</td>",
        "<td>0.512</td><td>at least 0.01</td><td>within</td>", "<td>5.2 of 6 degrees of freedom</td>",
        "<td>17.5 µm</td>", "<td>300.0 (x +0.0, y -300.0, z +0.5)</td>",
        "<td>0.25 (x +0.00, y +0.25, z +0.00)</td>", "<td>droop</td><td>97 %</td>",
        "<td>oval gears</td><td>–</td>"})
    EXPECT_THAT(page, HasSubstr(row));
  ProofDocument off = made_proof();
  off.verdict = {.accepted = false, .reasons = {"the touches are off"}};
  off.rms_mm = 0.05;
  EXPECT_THAT(verified_page(proof_record(off)),
              AllOf(HasSubstr("Verdict: not proved"), HasSubstr("does not meet the limits"),
                    HasSubstr("<li>the touches are off</li>"),
                    HasSubstr("<td>0.0500 mm</td><td>at most 0.03 mm</td><td>beyond</td>")));
}

TEST(VerificationHtml, AChecksFiguresStandBesideTheirLimits) {
  const std::string page = verified_page(check_record());
  for (const char* told :
       {"Verdict: changed", "joint 4 has changed by 0.200 mrad",
        "<td>0.00012</td><td>at least 0.005</td><td>beyond</td>",
        "<td>0.25</td><td>at least 0.005</td><td>within</td>", "<td>4</td><td>+0.200</td><td>0.031</td>",
        "<td>+23.6 ppm, known within 4.5 ppm (std)</td>", "<td>+1.0 K</td>", "<td>3 of 3 checks</td>",
        "of change since its reference only"})
    EXPECT_THAT(page, HasSubstr(told));
  CheckDocument same = made_check();
  same.verdict = {.accepted = true, .reasons = {}};
  same.warmer_k = -0.01;
  EXPECT_THAT(verified_page(check_record(same)),
              AllOf(HasSubstr("Verdict: unchanged"), HasSubstr("<td>0.0 K</td>")));
  same.warmer_k.reset();
  EXPECT_THAT(verified_page(check_record(same)),
              HasSubstr("<td>warmth that the growth stands for</td><td>–</td>"));
}

TEST(VerificationHtml, EachPlaneHasAFigureAndEachTouchARow) {
  const std::string page = verified_page(proof_record());
  EXPECT_THAT(page, AllOf(HasSubstr("<title>Plane 2</title>"), HasSubstr("<title>Plane 4</title>"),
                          Not(HasSubstr("<title>Plane 1</title>"))));
  EXPECT_THAT(page,
              HasSubstr("<td>2</td><td>2</td><td>-0.0200</td><td>1.500000, 0.000000, 0.000000, 90.000000, "
                        "-179.999999, -0.000002</td>"));
  EXPECT_THAT(page, HasSubstr("<td>LNE</td>"));
}

TEST(VerificationHtml, ARunWithoutAVerdictSaysWhy) {
  CheckDocument first{.arm = "tx90", .of_run = "7", .touch_count = 3, .complete = true};
  first.reference = {.count = 1, .needed = 3};
  first.verdict.reasons = {"reference check 1 of 3"};
  EXPECT_THAT(verified_page(check_record(first)),
              AllOf(HasSubstr("Verdict: none"), HasSubstr("<li>reference check 1 of 3</li>"),
                    HasSubstr("<td>chi-square</td><td>–</td>"), HasSubstr("<td>1 of 3 checks</td>")));

  VerificationRecord record = proof_record();
  record.own.result_json.reset();
  record.own.run.outcome = RunOutcome::kAborted;
  record.own.run.fault_message = "the link was lost";
  EXPECT_THAT(verified_page(record), AllOf(HasSubstr("<li>the run ended before it had a result</li>"),
                                           HasSubstr("<li>it ended with a fault: the link was lost</li>")));
  record.own.run.outcome = RunOutcome::kRunning;
  record.own.run.fault_message.reset();
  EXPECT_THAT(verified_page(record), HasSubstr("<li>the run is not over</li>"));
  record.own.result_json = R"({"schema":"touchcal/proof/9"})";
  EXPECT_THAT(verified_page(record),
              HasSubstr("the stored result cannot be read: &#39;touchcal/proof/9&#39;"));
  EXPECT_EQ(first_unclosed(verified_page(record)), "");
}

TEST(VerificationHtml, TextFromOutsideStaysText) {
  const std::string markup = "<script>alert('x')</script>\x01&\"";
  CheckDocument check = made_check();
  check.arm = markup;
  check.verdict.reasons = {markup};
  VerificationRecord hostile = check_record(check);
  hostile.cell = markup;
  hostile.own.run.operator_name = markup;
  hostile.own.run.recipe = markup;
  hostile.calibration->recipe = markup;
  hostile.calibration->ended_at = markup;
  SupersededTouch again;
  again.reason = markup;
  hostile.own.superseded.push_back(again);
  hostile.own.faults.push_back({.id = 1, .run_id = 9, .at = markup, .code = markup, .message = markup});
  ProofDocument proof = made_proof();
  proof.power[0].alternative = markup;
  for (const VerificationRecord& record : {hostile, proof_record(proof)}) {
    const std::string page = verified_page(record);
    EXPECT_THAT(page, Not(HasSubstr("<script")));
    EXPECT_THAT(page, HasSubstr("&lt;script&gt;alert(&#39;x&#39;)&lt;/script&gt;&amp;&quot;"));
    EXPECT_EQ(first_unclosed(page), "");
  }
}

TEST(VerificationHtml, ThePageNeedsNothingFromElsewhereAndRunsNothing) {
  for (const VerificationRecord& record : {proof_record(), check_record()}) {
    const std::string page = verified_page(record);
    for (const char* foreign : {"<script", "<img", "<link", "url(", "href", "src="})
      EXPECT_THAT(page, Not(HasSubstr(foreign)));
    EXPECT_EQ(first_unclosed(page), "");
  }
}

}  // namespace
}  // namespace cell
