// One expression: how it is read, and what a controller refuses in it.
#include "sim_controller/val3/language/expression_parser.hpp"

#include <gtest/gtest.h>

#include "sim_controller/val3/language/parser.hpp"
#include "sim_controller/val3/language/syntax_rules.hpp"

namespace val3 {
namespace {

/// With parentheses around every operation.
std::string written(const Expression& expression) {
  std::string parts;
  for (const Expression& part : expression.parts) parts += (parts.empty() ? "" : ",") + written(part);
  const std::string name = (expression.alias.empty() ? "" : expression.alias + ":") + expression.text;
  const auto rest = [&] { return parts.substr(written(expression.parts[0]).size()); };
  switch (expression.kind) {
    case Expression::Kind::kNumber: {
      std::string number = std::to_string(expression.number);
      number.erase(number.find_last_not_of('0') + 1);
      return number.ends_with('.') ? number.substr(0, number.size() - 1) : number;
    }
    case Expression::Kind::kTruth:
      return expression.number == 0.0 ? "false" : "true";
    case Expression::Kind::kText:
      return '"' + expression.text + '"';
    case Expression::Kind::kName:
      return name;
    case Expression::Kind::kIndex:
      return written(expression.parts[0]) + '[' + rest().substr(1) + ']';
    case Expression::Kind::kField:
      return parts + '.' + expression.text;
    case Expression::Kind::kCall:
      return name + '(' + parts + ')';
    case Expression::Kind::kUnary:
      return '(' + expression.text + parts + ')';
    case Expression::Kind::kBinary:
      return '(' + written(expression.parts[0]) + ' ' + expression.text + ' ' + written(expression.parts[1]) +
             ')';
    case Expression::Kind::kBraces:
      return '{' + parts + '}';
  }
  return {};
}

struct ReadExpression {
  Expression expression;
  std::optional<LineProblem> problem;
};

ReadExpression read_expression(std::string_view text) {
  std::vector<Token> tokens;
  std::optional<LineProblem> warning;
  const auto problem = tokens_of(text, tokens, warning);
  ExpressionParser in(tokens, 1);
  ReadExpression result{in.expression(), {}};
  in.expect_end();
  result.problem = problem ? problem : in.problem();
  return result;
}

std::string read_as(std::string_view text) {
  const auto [expression, problem] = read_expression(text);
  return problem ? "refused: " + problem->what : written(expression);
}

std::string refused_by(std::string_view text) {
  const auto [expression, problem] = read_expression(text);
  return problem ? std::string(problem->rule) : "read as " + written(expression);
}

TEST(Expressions, BindByTheRanksOfTheManual) {
  EXPECT_EQ(read_as("a or b and c xor d"), "(a or (b and (c xor d)))");
  EXPECT_EQ(read_as("a==b and c!=d or e"), "(((a == b) and (c != d)) or e)");
  EXPECT_EQ(read_as("a==b<c"), "(a == (b < c))");
  EXPECT_EQ(read_as("a<=b+c*d"), "(a <= (b + (c * d)))");
  EXPECT_EQ(read_as("-a*b"), "((-a) * b)");
  EXPECT_EQ(read_as("!a and !b"), "((!a) and (!b))");
  EXPECT_EQ(read_as("(a+b)*c"), "((a + b) * c)");
}

TEST(Expressions, OfOneRankAreTakenFromTheLeft) {
  EXPECT_EQ(read_as("a-b+c"), "((a - b) + c)");
  EXPECT_EQ(read_as("a/b*c%d"), "(((a / b) * c) % d)");
  EXPECT_EQ(read_as("a or b or c"), "((a or b) or c)");
}

TEST(Expressions, HaveValuesOfAllForms) {
  EXPECT_EQ(read_as("12.5"), "12.5");
  EXPECT_EQ(read_as(".02"), "0.02");
  EXPECT_EQ(read_as("-3"), "(-3)");
  EXPECT_EQ(read_as("true"), "true");
  EXPECT_EQ(read_as(R"("C:\new // no comment")"), R"("C:\new // no comment")");
  EXPECT_EQ(read_as("{{1,2,3},{sfree,efree}}"), "{{1,2,3},{sfree,efree}}");
}

TEST(Expressions, NameElementsFieldsAndLibraries) {
  EXPECT_EQ(read_as("a[1]"), "a[1]");
  EXPECT_EQ(read_as("a[i+1,2,3].trsf.x"), "a[(i + 1),2,3].trsf.x");
  EXPECT_EQ(read_as("user[0].field[2]"), "user[0].field[2]");
  EXPECT_EQ(read_as(R"(collection["key"])"), R"(collection["key"])");
  EXPECT_EQ(read_as("lib:value[2]"), "lib:value[2]");
  EXPECT_EQ(read_as(R"(lib:libLoad("path"))"), R"(lib:libLoad("path"))");
  EXPECT_EQ(read_as("here(flange,world).trsf.z"), "here(flange,world).trsf.z");
  EXPECT_EQ(read_as("$getJntFbk()"), "$getJntFbk()");
  EXPECT_EQ(read_as("a[.5]"), "a[0.5]");
}

TEST(Expressions, SayWhereTheyStand) {
  const auto [expression, problem] = read_expression("  ab + cd");
  ASSERT_FALSE(problem);
  EXPECT_EQ(expression.column, 6);
  EXPECT_EQ(expression.parts[0].column, 3);
  EXPECT_EQ(expression.parts[1].column, 8);
}

TEST(Expressions, ThatAControllerRefusesAreRefused) {
  EXPECT_EQ(refused_by("a=b"), syntax_rules::kAssignmentInExpression);
  EXPECT_EQ(refused_by("f(a=b)"), syntax_rules::kAssignmentInExpression);
  EXPECT_EQ(refused_by("(a=b)"), syntax_rules::kAssignmentInExpression);
  EXPECT_EQ(refused_by("--a"), syntax_rules::kTwoUnaryOperators);
  EXPECT_EQ(refused_by("!-a"), syntax_rules::kTwoUnaryOperators);
  EXPECT_EQ(refused_by("(a+b"), syntax_rules::kMissingBracket);
  EXPECT_EQ(refused_by("a[1"), syntax_rules::kMissingBracket);
  EXPECT_EQ(refused_by("{1,2"), syntax_rules::kMissingBracket);
  EXPECT_EQ(refused_by("a+b)"), syntax_rules::kMissingBracket);
  EXPECT_EQ(refused_by("a b"), syntax_rules::kTrailingCharacters);
  EXPECT_EQ(refused_by("1e5"), syntax_rules::kTrailingCharacters);
  EXPECT_EQ(refused_by("a // why"), syntax_rules::kTrailingComment);
  EXPECT_EQ(refused_by("\"open"), syntax_rules::kMissingQuote);
  EXPECT_EQ(refused_by(std::string(400, '9')), syntax_rules::kNumberTooLarge);
  for (const char* text :
       {"a+", "a<>b", "a&&b", "1.", "a[1,2,3,4]", "a.5", "a[]", "f(a,)", "to", "a#b", ":a", ""})
    EXPECT_EQ(refused_by(text), syntax_rules::kSyntax) << text;
}

TEST(Expressions, AreReadToTheirDepthAndNoDeeper) {
  const auto nested = [](int depth) {
    const auto times = static_cast<std::size_t>(depth);
    return std::string(times, '(') + "1" + std::string(times, ')');
  };
  EXPECT_EQ(read_as(nested(kExpressionDepthMax - 1)), "1");
  EXPECT_EQ(refused_by(nested(kExpressionDepthMax)), syntax_rules::kExpressionTooDeep);
  EXPECT_EQ(refused_by(nested(1'000'000)), syntax_rules::kExpressionTooDeep);
}

TEST(Expressions, TellOfATextThatNoStringHolds) {
  std::vector<Token> tokens;
  std::optional<LineProblem> warning;
  EXPECT_FALSE(tokens_of('"' + std::string(kTextBytesMax, 'a') + '"', tokens, warning));
  EXPECT_FALSE(warning);
  const std::string long_text = '"' + std::string(kTextBytesMax + 1, 'a') + '"';
  EXPECT_FALSE(tokens_of(long_text, tokens, warning));
  ASSERT_TRUE(warning);
  EXPECT_EQ(warning->rule, syntax_rules::kStringTooLong);
}

}  // namespace
}  // namespace val3
