#include "service/documents/checks_document.hpp"
#include "service/documents/verification_document.hpp"
#include "tests/service/http/routes/routes_bench.hpp"

namespace cell {
namespace {

using ::testing::HasSubstr;
using ::testing::SizeIs;

Cell checked_weekly() {
  Cell cell = edf();
  cell.check_every = std::chrono::days(7);
  return cell;
}

class CheckRoutesTest : public RoutesTest {
 protected:
  CheckRoutesTest() : RoutesTest(checked_weekly()) {}
  std::int64_t accepted_calibration() {
    const std::int64_t run = stored_run();
    cell_.store().finish_run(run, {.verdict = Verdict::kAccepted, .ended_at = "1970-01-01T00:00:00.000Z"});
    return run;
  }
  std::int64_t ended_check(std::int64_t calibration, const std::string& result,
                           Verdict verdict = Verdict::kAccepted) {
    const std::int64_t run = cell_.store().begin_run({.kind = RunKind::kCheck,
                                                      .of_run = calibration,
                                                      .recipe = "edf-25",
                                                      .started_at = "start",
                                                      .operator_name = "M. Curie"});
    cell_.store().finish_run(
        run, {.verdict = verdict, .ended_at = "1970-01-01T00:00:00.000Z", .result_json = result});
    return run;
  }
  static std::string result_with(double offset_mrad) {
    CheckDocument document;
    document.verdict.accepted = true;
    document.joints = {{.joint = 4, .offset_mrad = offset_mrad}};
    return document_text(document);
  }
};

TEST_F(CheckRoutesTest, TellsTheChecksOfTheCalibrationThatCounts) {
  const std::int64_t older = accepted_calibration();
  ended_check(older, result_with(0.5));
  const std::int64_t calibration = accepted_calibration();
  const std::int64_t check = ended_check(calibration, result_with(0.125));
  const HttpResponse response = get("/api/v1/checks");
  ASSERT_EQ(response.status, 200u) << response.body;
  const ChecksDocument document = read_checks(response.body);
  EXPECT_EQ(document.of_run, std::to_string(calibration));
  ASSERT_THAT(document.checks, SizeIs(1));
  EXPECT_EQ(document.checks[0].run, std::to_string(check));
  EXPECT_EQ(document.checks[0].operator_name, "M. Curie");
  EXPECT_EQ(document.charts.at(2).quantity, "joint_4");
  EXPECT_EQ(document.charts.at(2).points.at(0).value, 0.125);
  EXPECT_EQ(document.due_at, "1970-01-08T00:00:00.000Z");
  const ChecksDocument before = read_checks(get("/api/v1/checks?of_run=" + std::to_string(older)).body);
  EXPECT_EQ(before.charts.at(2).points.at(0).value, 0.5);
  EXPECT_FALSE(before.due_at) << "it was replaced";
}

TEST_F(CheckRoutesTest, ACheckWhoseResultCannotBeReadHasNoVerdict) {
  ended_check(accepted_calibration(), R"({"schema":"touchcal/check/9"})", Verdict::kIncomplete);
  const ChecksDocument document = read_checks(get("/api/v1/checks").body);
  ASSERT_THAT(document.checks, SizeIs(1));
  EXPECT_FALSE(document.checks[0].accepted || document.checks[0].reference);
}

TEST_F(CheckRoutesTest, TellsSoManyOfTheNewestAsAreAskedFor) {
  const std::int64_t calibration = accepted_calibration();
  for (int i = 0; i < 3; ++i) ended_check(calibration, result_with(0.1 * i));
  const ChecksDocument document = read_checks(get("/api/v1/checks?limit=2").body);
  EXPECT_THAT(document.checks, SizeIs(2));
  EXPECT_EQ(document.count, 3);
  EXPECT_EQ(document.charts.at(2).points.back().value, 0.2);
  for (const char* limit : {"0", "1001", "x"})
    EXPECT_EQ(problem(get(std::string("/api/v1/checks?limit=") + limit)).at("status"), 400) << limit;
}

TEST_F(CheckRoutesTest, TheReportOfACheckHasThoseUpToItAndLaterOnesChangeNothing) {
  const std::int64_t calibration = accepted_calibration();
  const std::int64_t first = ended_check(calibration, result_with(0.1));
  const auto report = [&] { return get(path_of(first) + "/report?format=json").body; };
  const std::string before = report();
  ended_check(calibration, result_with(0.2));
  EXPECT_EQ(report(), before);
  const auto checks = nlohmann::json::parse(before).at("checks");
  EXPECT_EQ(checks.at("count"), 1);
  EXPECT_EQ(checks.at("checks").at(0).at("run"), std::to_string(first));
}

TEST_F(CheckRoutesTest, ACheckHasAReportInThreeFormsAndNoSimulation) {
  const std::string report = path_of(ended_check(accepted_calibration(), result_with(0.125))) + "/report";
  EXPECT_THAT(get(report).content_type, HasSubstr("text/html"));
  EXPECT_THAT(get(report + "?format=csv").body, HasSubstr(",deviation_mm,captured_at"));
  EXPECT_EQ(nlohmann::json::parse(get(report + "?format=json").body).at("schema"),
            "touchcal/verification-report/1");
  EXPECT_EQ(problem(get(report + "?format=docx")).at("status"), 400);
  EXPECT_THAT(problem(post(report + "/monte-carlo")).at("detail").get<std::string>(),
              HasSubstr("is a check, which calibrates nothing"));
}

TEST_F(CheckRoutesTest, RefusesWhatIsNoCalibration) {
  EXPECT_EQ(problem(get("/api/v1/checks")).at("status"), 409);
  const std::int64_t check = ended_check(accepted_calibration(), result_with(0.0));
  for (const std::string& run : {std::to_string(check), std::string("4711")})
    EXPECT_THAT(problem(get("/api/v1/checks?of_run=" + run)).at("detail").get<std::string>(),
                HasSubstr("no calibration '" + run));
  for (const char* query : {"of_run=0", "of_run=x", "of_run=-1", "run=1"})
    EXPECT_EQ(problem(get(std::string("/api/v1/checks?") + query)).at("status"), 400) << query;
}

}  // namespace
}  // namespace cell
