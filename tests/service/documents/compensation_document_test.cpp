#include "service/documents/compensation_document.hpp"

#include <gtest/gtest.h>

#include "config/targets_file.hpp"
#include "service/documents/document_error.hpp"

namespace cell {
namespace {

using calib::CompensationStatus;

CompensationDocument three_targets() {
  CompensationDocument document{.model = "abc"};
  document.targets = {
      {.name = "p1", .status = CompensationStatus::kOk, .joints_deg = {{1.0, -2.5, 3.0, 4.0, 5.0, 1e-9}}},
      {.name = "p2", .status = CompensationStatus::kRefused, .reason = "out of reach"},
      {.name = "p3", .status = CompensationStatus::kWarned, .joints_deg = {{0.0, 0.0, 0.0, 0.0, 0.0, 0.0}}}};
  return document;
}

TEST(CompensationDocument, IsReadAsItWasWritten) {
  const std::string text = document_text(three_targets());
  const CompensationDocument read = read_compensation(text);
  EXPECT_EQ(document_text(read), text);
  EXPECT_EQ(read.count(CompensationStatus::kOk), 1);
  EXPECT_EQ(read.count(CompensationStatus::kWarned), 1);
  EXPECT_EQ(read.count(CompensationStatus::kRefused), 1);
  EXPECT_THROW(read_compensation("{}"), DocumentError);
}

TEST(CompensationDocument, OnlyOfVersion2SaysWhatWasInserted) {
  EXPECT_EQ(document_text(three_targets()).find("inserted"), std::string::npos);
  CompensationDocument document = three_targets();
  document.schema = kCompensatedSchema;
  for (auto& target : document.targets) {
    target.inserted = target.name == "p2";
    target.line_deviation_mm.emplace();
  }
  *document.targets[2].line_deviation_mm = 0.0125;
  const std::string text = document_text(document);
  EXPECT_NE(text.find(R"("inserted":true,"line_deviation_mm":null)"), std::string::npos) << text;
  const CompensationDocument read = read_compensation(text);
  EXPECT_EQ(document_text(read), text);
  EXPECT_EQ(read.count_inserted(), 1);
  EXPECT_EQ(**read.targets[2].line_deviation_mm, 0.0125);
  EXPECT_EQ(three_targets().count_inserted(), 0);
}

TEST(CompensationDocument, OfRefusedTargetsTheCsvHasNoJoints) {
  EXPECT_EQ(compensated_csv(three_targets()),
            "name,j1_deg,j2_deg,j3_deg,j4_deg,j5_deg,j6_deg\n"
            "p1,1.000000000,-2.500000000,3.000000000,4.000000000,5.000000000,0.000000001\n"
            "p2,,,,,,\n"
            "p3,0.000000000,0.000000000,0.000000000,0.000000000,0.000000000,0.000000000\n");
}

TEST(CompensationDocument, TheCsvIsReadAsTargets) {
  CompensationDocument taken = three_targets();
  taken.targets.erase(taken.targets.begin() + 1);
  EXPECT_EQ(targets_from_csv("t.csv", compensated_csv(taken)).targets.size(), 2U);
}

}  // namespace
}  // namespace cell
