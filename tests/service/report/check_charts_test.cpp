#include <gmock/gmock.h>

#include "service/report/internal/verification_parts.hpp"
#include "service/report/verification_html.hpp"
#include "tests/service/report/verified_run.hpp"

namespace cell {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

TEST(CheckCharts, EachQuantityWithTwoPointsIsAFigureWithItsLimits) {
  const std::string drawn = check_charts(english(), charted_checks());
  EXPECT_THAT(drawn, AllOf(HasSubstr("14 checks up to this one, reference of 3 of 3, limits from 10 of 10"),
                           HasSubstr("Joint 4, as if it alone had changed"), HasSubstr("weighted mean"),
                           HasSubstr(">limits</text>"), HasSubstr("first checks")));
  EXPECT_THAT(drawn, Not(HasSubstr("Growth of the arm"))) << "one point is no curve";
}

TEST(CheckCharts, WithoutTwoPointsThereIsASentence) {
  ChecksDocument checks = charted_checks();
  checks.charts.front().points.resize(1);
  EXPECT_THAT(check_charts(english(), checks), AllOf(HasSubstr("A figure begins"), Not(HasSubstr("<svg"))));
}

TEST(CheckCharts, AreInTheReportOfACheckAndInNoProof) {
  VerificationRecord record = check_record();
  record.checks = charted_checks();
  const auto page = [](const VerificationRecord& of) {
    return verification_html(read_verification_report(verification_report_document(of)), "2026-02-04");
  };
  EXPECT_THAT(page(record), HasSubstr("From check to check"));
  EXPECT_THAT(page(proof_record()), Not(HasSubstr("From check to check")));
}

}  // namespace
}  // namespace cell
