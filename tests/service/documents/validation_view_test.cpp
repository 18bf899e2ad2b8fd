#include "service/documents/validation_view.hpp"

#include <gtest/gtest.h>

#include "tests/service/document_shape.hpp"
#include "tests/service/table3_result.hpp"

namespace cell {
namespace {

json document_with(std::span<const calib::Touch> others) {
  const Recipe& recipe = edf().recipes.at("edf-25");
  const calib::IdentificationProblem problem = problem_of(recipe);
  return json::parse(
      validation_document(edf(), recipe, problem, calib::validate(problem, recipe.identification, others)));
}

TEST(ValidationDocument, HasItsFieldsWithTheirTypes) {
  const json document = document_with(table3_touches());
  EXPECT_EQ(shape_of(document), (Shape{{"schema", "string"},
                                       {"arm", "string"},
                                       {"recipe", "string"},
                                       {"touch_count", "number"},
                                       {"identifiable_count", "number"},
                                       {"warnings", "array"},
                                       {"same_touches", "object"},
                                       {"other_touches", "object"},
                                       {"planes", "array"},
                                       {"planes_held_out", "array"}}));
  Shape repetition{{"done", "boolean"},
                   {"why_not", "null"},
                   {"touch_count", "number"},
                   {"iterations", "number"},
                   {"new_error_max_si", "number"},
                   {"parameters", "array"}};
  EXPECT_EQ(shape_of(document.at("other_touches")), repetition);
  repetition["limit_si"] = "number";
  repetition["passed"] = "boolean";
  EXPECT_EQ(shape_of(document.at("same_touches")), repetition);
  for (const json& parameter : document.at("other_touches").at("parameters")) {
    const char* figure = parameter.at("status") == "identified" ? "number" : "null";
    EXPECT_EQ(shape_of(parameter), (Shape{{"name", "string"},
                                          {"frame", "number"},
                                          {"kind", "string"},
                                          {"unit", "string"},
                                          {"status", "string"},
                                          {"new_error", figure},
                                          {"std_new_error", figure}}));
  }
}

TEST(ValidationDocument, ASetThatWasNotTriedHasAReasonAndNoFigures) {
  const json other = document_with({}).at("other_touches");
  EXPECT_EQ(other.at("done"), false);
  EXPECT_TRUE(other.at("why_not").is_string());
  EXPECT_TRUE(other.at("new_error_max_si").is_null());
  for (const json& parameter : other.at("parameters")) {
    EXPECT_TRUE(parameter.at("new_error").is_null());
    EXPECT_TRUE(parameter.at("std_new_error").is_null());
  }
}

}  // namespace
}  // namespace cell
