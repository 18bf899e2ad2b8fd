#include "service/documents/result_document.hpp"

#include <gmock/gmock.h>

#include "service/cli/result_text.hpp"
#include "service/cli/validation_text.hpp"
#include "service/documents/document_error.hpp"
#include "service/documents/limit_table.hpp"
#include "service/documents/validation_view.hpp"
#include "tests/service/table3_result.hpp"

namespace cell {
namespace {

using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

/// With a validation, and conditions of a version that knew more.
std::string stored_text() {
  const Recipe& recipe = edf().recipes.at("edf-25");
  const calib::IdentificationProblem problem = problem_of(recipe);
  return result_document(regions(), recipe, problem, calib::identify(problem, recipe.identification),
                         {.complete = true, .warnings = {"a warning"}, .conditions = R"({"later":[1]})"});
}

TEST(ResultDocument, IsWrittenAsItWasRead) {
  const std::string text = stored_text();
  EXPECT_EQ(document_text(read_result(text)), text);
  EXPECT_EQ(json::parse(text).at("conditions"), json::parse(R"({"later":[1]})"));
}

TEST(ResultDocument, AsTextHasEachCriterionWithItsDecision) {
  const ResultDocument result = read_result(stored_text());
  const std::string text = result_text(result);
  const std::vector<LimitRow> rows = limit_rows(result.verdict.decision_rule.value());
  ASSERT_FALSE(rows.empty());
  for (const LimitRow& row : rows) {
    const std::size_t at = text.find("\n" + row.criterion + " ");
    ASSERT_NE(at, std::string::npos) << row.criterion;
    const std::string line = text.substr(at + 1, text.find('\n', at + 1) - at - 1);
    EXPECT_THAT(line, HasSubstr(" " + row.value + " "));
    EXPECT_THAT(line, ::testing::EndsWith("  " + row.decision));
  }
}

TEST(ResultDocument, OfAnEarlierVersionIsShownWithoutWhatItLacks) {
  const json whole = json::parse(stored_text());
  for (const auto& [key, unused] : whole.items()) {
    json older = whole;
    older.erase(key);
    EXPECT_THAT(result_text(read_result(older.dump())), HasSubstr("verdict: ")) << key;
  }
  EXPECT_EQ(read_result("{}").identifiable_count, std::nullopt);
}

TEST(ResultDocument, AFieldThatCannotBeReadIsNamed) {
  json broken = json::parse(stored_text());
  broken["parameters"][3]["error"] = "0.1";
  EXPECT_THAT([&] { read_result(broken.dump()); },
              ThrowsMessage<DocumentError>("/parameters/3/error: expected a number, found string"));
  EXPECT_THAT([] { read_result("[]"); },
              ThrowsMessage<DocumentError>("the document: expected an object, found array"));
  EXPECT_THROW(read_result("{"), NotJson);
}

TEST(ResultDocument, ItsVerdictIsPassedOnAsItStandsThere) {
  EXPECT_EQ(verdict_text(R"({"verdict":{"reasons":[],"accepted":true,"later":1}})"),
            R"({"accepted":true,"later":1,"reasons":[]})");
}

TEST(ValidationDocument, IsWrittenAsItWasRead) {
  const Recipe& recipe = edf().recipes.at("edf-25");
  const calib::IdentificationProblem problem = problem_of(recipe);
  const auto made = calib::validate(problem, recipe.identification, problem.touches);
  const std::string text = validation_document(edf(), recipe, problem, made);
  EXPECT_EQ(document_text(read_validation(text)), text);
  EXPECT_EQ(validation_text(read_validation(text)),
            validation_text(validation_of(edf(), recipe, problem, made)));
}

}  // namespace
}  // namespace cell
