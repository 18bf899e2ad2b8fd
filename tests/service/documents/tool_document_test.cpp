#include "service/documents/tool_document.hpp"

#include <gtest/gtest.h>

#include "service/documents/document_error.hpp"

namespace cell {
namespace {

TEST(ToolDocument, IsReadBackAsItWasWritten) {
  ToolDocument document{.arm = "tx90", .tool = "gripper", .of_run = "7", .touch_count = 8, .complete = true};
  document.verdict = {.accepted = true, .reasons = {}};
  document.drawn_mm = {0.0, 0.0, 250.0};
  document.position_mm = {0.125, -0.25, 250.5};
  document.off_drawing_mm = 0.5728;
  document.arm_errors = {{.name = "beta6", .unit = "rad", .error = -0.0015}};
  document.touches = {{.touch = 1, .plane = 3, .distance_mm = -0.0125}};
  const std::string text = document_text(document);
  const ToolDocument again = read_tool(text);
  EXPECT_EQ(schema_of(text), "touchcal/tool/1");
  EXPECT_EQ(document_text(again), text);
  EXPECT_EQ(again.position_mm, document.position_mm);
  EXPECT_FALSE(again.std_position_mm);
}

TEST(ToolDocument, OfAnotherSchemaIsRefused) {
  ToolDocument document;
  document.schema = "touchcal/tool/2";
  EXPECT_THROW(read_tool(document_text(document)), DocumentError);
  EXPECT_THROW(read_tool(document_text(ProofDocument())), DocumentError);
  EXPECT_THROW(read_tool("{}"), DocumentError);
}

}  // namespace
}  // namespace cell
