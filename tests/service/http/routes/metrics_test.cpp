#include "service/http/routes/metrics.hpp"

#include <gmock/gmock.h>

#include <chrono>

#include "service/run/cell_figures.hpp"
#include "service/run/fault_table.hpp"

namespace cell {
namespace {

using namespace std::chrono_literals;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

constexpr CellFigures::Time kScrape{100h};

TEST(Metrics, OfWhatIsStoredAreUnknownBeforeItWasRead) {
  Metrics metrics;
  const std::string text = metrics.text({}, kScrape);
  for (const char* one : {"touchcal_check_age_seconds", "touchcal_check_due_seconds",
                          "touchcal_arm_growth_ratio", "touchcal_check_passed", "touchcal_proof_passed",
                          "touchcal_approved_model_age_seconds", "touchcal_approved_model_of_this_arm"})
    EXPECT_THAT(text, HasSubstr(std::string("\n") + one + " Nan\n"));
  for (const char* family :
       {"touchcal_check_joint_radians", "touchcal_check_limit_ratio", "touchcal_certificate_valid_seconds"})
    EXPECT_THAT(text, Not(HasSubstr(std::string("\n") + family + "{"))) << "nothing is no row";
}

TEST(Metrics, WhatIsAlertedWhenItRisesIsThereFromTheStart) {
  Metrics metrics;
  for (const FaultEntry& entry : fault_table())
    EXPECT_THAT(metrics.text({}, kScrape),
                HasSubstr("\ntouchcal_faults_total{code=\"" + std::string(entry.name) + "\"} 0\n"));
  EXPECT_THAT(metrics.text({}, kScrape), HasSubstr("\ntouchcal_internal_errors_total 0\n"));
  for (const unsigned status : {404U, 500U, 503U}) metrics.count_request("GET", "/api/v1/fleet", status);
  EXPECT_THAT(metrics.text({}, kScrape), HasSubstr("\ntouchcal_internal_errors_total 1\n"))
      << "an archive that is away is no error of the daemon";
  metrics.count_internal_error();
  EXPECT_THAT(metrics.text({}, kScrape), HasSubstr("\ntouchcal_internal_errors_total 2\n"));
}

TEST(Metrics, OfWhatIsStoredAreInBaseUnits) {
  Metrics metrics;
  metrics.take({.checked_at = kScrape - 10min,
                .check_due_at = kScrape + 1h,
                .joint_offsets_rad = {{2, -0.25}, {5, 0.5}},
                .arm_growth = 0.125,
                .limit_ratios = {{"joint_2", 0.75}, {"growth", 1.5}},
                .is_proved = true,
                .model_approved_at = kScrape - 2s,
                .is_model_of_this_arm = false,
                .certificate_ends = {{"block", kScrape + 30s}, {"probe", kScrape - 30s}}});
  const std::string text = metrics.text({}, kScrape);
  for (const char* row :
       {"touchcal_check_age_seconds 600", "touchcal_check_due_seconds 3600",
        "touchcal_arm_growth_ratio 0.125", "touchcal_check_joint_radians{joint=\"2\"} -0.25",
        "touchcal_check_joint_radians{joint=\"5\"} 0.5",
        "touchcal_check_limit_ratio{quantity=\"joint_2\"} 0.75",
        "touchcal_check_limit_ratio{quantity=\"growth\"} 1.5", "touchcal_proof_passed 1",
        "touchcal_approved_model_age_seconds 2", "touchcal_approved_model_of_this_arm 0",
        "touchcal_certificate_valid_seconds{artefact=\"block\"} 30",
        "touchcal_certificate_valid_seconds{artefact=\"probe\"} -30"})
    EXPECT_THAT(text, HasSubstr(std::string("\n") + row + "\n"));
}

TEST(Metrics, AgesAreThoseOfTheScrapeAndNotOfTheReading) {
  Metrics metrics;
  metrics.take({.checked_at = kScrape, .check_due_at = kScrape + 1h});
  EXPECT_THAT(metrics.text({}, kScrape + 2h), AllOf(HasSubstr("\ntouchcal_check_age_seconds 7200\n"),
                                                    HasSubstr("\ntouchcal_check_due_seconds -3600\n")));
  EXPECT_THAT(metrics.text({}, kScrape - 1h), HasSubstr("\ntouchcal_check_age_seconds 0\n"))
      << "the clock was set back";
}

TEST(Metrics, HaveTheMachinesTimeForAPrometheusToCompareWithItsOwn) {
  Metrics metrics;
  EXPECT_THAT(metrics.text({}, kScrape), HasSubstr("\ntouchcal_time_seconds 360000\n"));
}

TEST(Metrics, RowsOfWhatIsNotKnownAnyMoreGo) {
  Metrics metrics;
  metrics.take({.joint_offsets_rad = {{2, 0.5}, {3, 0.5}}, .is_proved = false});
  EXPECT_THAT(metrics.text({}, kScrape), HasSubstr("\ntouchcal_proof_passed 0\n"));
  metrics.take({.joint_offsets_rad = {{3, 0.25}}});
  EXPECT_THAT(metrics.text({}, kScrape),
              AllOf(Not(HasSubstr("joint=\"2\"")), HasSubstr("{joint=\"3\"} 0.25\n"),
                    HasSubstr("\ntouchcal_proof_passed Nan\n")));
}

}  // namespace
}  // namespace cell
