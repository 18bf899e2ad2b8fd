#include "service/documents/qualification_document.hpp"

#include <gtest/gtest.h>

#include "service/documents/document_error.hpp"

namespace cell {
namespace {

TEST(QualificationDocument, IsReadBackAsItWasWritten) {
  QualificationDocument document{.arm = "tx90", .probe = "lp2", .touch_count = 25, .complete = true};
  document.no_of_run = "none was accepted";
  document.verdict = {.accepted = false, .reasons = {"loose"}};
  document.scatter = {.std_um = 12.5, .degrees_of_freedom = 9.0, .low_um = 8.6, .high_um = 22.8};
  document.run_out = {.size_mm = 0.2, .std_mm = 0.01, .direction_deg = 30.0};
  document.lengths = {{.planes = {3, 5}, .known_mm = 150.0, .error_mm = -0.01, .std_mm = 0.02, .p = 0.6}};
  document.criteria = {{.name = "length_3_5", .unit = "mm", .value = 0.01, .expanded = 0.04, .passed = true}};
  document.touches = {{.touch = 1, .plane = 3, .joint_6_deg = 45.0, .deviation_mm = 0.001}};
  const std::string text = document_text(document);
  const QualificationDocument again = read_qualification(text);
  EXPECT_EQ(schema_of(text), "touchcal/qualification/1");
  EXPECT_EQ(document_text(again), text);
  EXPECT_EQ(again.lengths.front().planes.at(1), 5);
  EXPECT_FALSE(again.criteria.front().limit);
}

TEST(QualificationDocument, OfAnotherSchemaIsRefused) {
  QualificationDocument document;
  document.schema = "touchcal/qualification/2";
  EXPECT_THROW(read_qualification(document_text(document)), DocumentError);
  EXPECT_THROW(read_qualification(document_text(CheckDocument())), DocumentError);
  EXPECT_THROW(read_qualification("{}"), DocumentError);
}

}  // namespace
}  // namespace cell
