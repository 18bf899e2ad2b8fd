#include "service/documents/verification_document.hpp"

#include <gmock/gmock.h>

#include "service/documents/document_error.hpp"

namespace cell {
namespace {

TEST(VerificationDocument, AProofIsReadBackAsItWasWritten) {
  ProofDocument proof{.arm = "tx90", .of_run = "3", .touch_count = 12, .complete = true};
  proof.verdict = {.accepted = false, .reasons = {"off"}};
  proof.moved_mm = {0.0, -300.0, 0.5};
  proof.power = {{.alternative = "droop", .power = 0.99}};
  proof.touches = {{.touch = 1, .plane = 4, .distance_mm = 0.01}};
  const std::string text = document_text(proof);
  EXPECT_EQ(schema_of(text), "touchcal/proof/1");
  EXPECT_EQ(document_text(read_proof(text)), text);
  EXPECT_EQ(read_proof(text).verdict.accepted, false);
  EXPECT_EQ(read_proof(text).rms_mm, std::nullopt);
}

TEST(VerificationDocument, ACheckIsReadBackAsItWasWritten) {
  CheckDocument check{.arm = "tx90", .of_run = "3", .touch_count = 12, .complete = true};
  check.reference = {.count = 3, .needed = 3};
  check.cause = "joint";
  check.joint = 4;
  check.joints = {{.joint = 4, .offset_mrad = 0.2, .std_offset_mrad = 0.01}};
  const std::string text = document_text(check);
  EXPECT_EQ(schema_of(text), "touchcal/check/1");
  EXPECT_EQ(document_text(read_check(text)), text);
  EXPECT_EQ(read_check(text).verdict.accepted, std::nullopt);
}

TEST(VerificationDocument, AnotherSchemaOrACauseThatNobodyKnowsIsRefused) {
  CheckDocument check;
  check.schema = "touchcal/check/9";
  EXPECT_THROW(read_check(document_text(check)), DocumentError);
  ProofDocument proof;
  proof.schema = "touchcal/proof/2";
  EXPECT_THROW(read_proof(document_text(proof)), DocumentError);
  check = CheckDocument();
  for (const char* cause : {"joint", "block", "stylus", "unknown"}) {
    check.cause = cause;
    EXPECT_EQ(read_check(document_text(check)).cause, cause);
  }
  check.cause = "moon";
  EXPECT_THROW(read_check(document_text(check)), DocumentError);
}

TEST(VerificationDocument, OneIsNotTakenForTheOther) {
  EXPECT_THROW(read_proof(document_text(CheckDocument())), DocumentError);
  EXPECT_THROW(read_check("{}"), DocumentError);
  EXPECT_EQ(schema_of("{}"), "");
  EXPECT_THROW(schema_of("["), DocumentError);
}

}  // namespace
}  // namespace cell
