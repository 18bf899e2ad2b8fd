#include "service/http/server/problem.hpp"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <set>

namespace cell {
namespace {

TEST(ProblemDocument, HasTheMembersOfRfc9457AndOursWhereTheyAreGiven) {
  const HttpResponse response =
      to_response({.status = 422, .kind = ProblemKind::kNoPlan, .detail = "no way", .pointer = "/recipe"});
  EXPECT_EQ(response.status, 422U);
  EXPECT_EQ(response.content_type, "application/problem+json");
  const auto document = nlohmann::json::parse(response.body);
  EXPECT_EQ(document.at("type"), "urn:touchcal:problem:no-plan");
  EXPECT_EQ(document.at("title"), "Not possible");
  EXPECT_EQ(document.at("status"), 422);
  EXPECT_EQ(document.at("detail"), "no way");
  EXPECT_EQ(document.at("pointer"), "/recipe");
  EXPECT_FALSE(document.contains("errors"));
  EXPECT_TRUE(response.headers.empty());
}

TEST(ProblemDocument, OfWhatPassesByItselfSaysWhenToAskAgain) {
  const HttpResponse response =
      to_response({.status = 503, .kind = ProblemKind::kBusy, .detail = "full", .retry_after_s = 5});
  ASSERT_EQ(response.headers.size(), 1U);
  EXPECT_EQ(response.headers.front(), (std::pair<std::string, std::string>("Retry-After", "5")));
}

TEST(ProblemDocument, EveryKindHasANameOfItsOwn) {
  std::set<std::string_view> names;
  int kind = 0;
  for (; !problem_kind_name(static_cast<ProblemKind>(kind)).empty(); ++kind)
    names.insert(problem_kind_name(static_cast<ProblemKind>(kind)));
  EXPECT_GE(kind, 25);
  EXPECT_EQ(names.size(), static_cast<std::size_t>(kind));
}

}  // namespace
}  // namespace cell
