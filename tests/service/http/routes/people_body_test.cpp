#include "service/http/routes/internal/people_body.hpp"

#include <gtest/gtest.h>

namespace cell {
namespace {

std::string pointer_of(const Problem& problem) { return problem.pointer.value_or("none"); }

TEST(PeopleBody, ASignInIsANameAndASecret) {
  const auto read = read_sign_in(R"({"name":"Jürgen","secret":"123456"})");
  ASSERT_TRUE(std::holds_alternative<SignInBody>(read));
  EXPECT_EQ(std::get<SignInBody>(read).name, "Jürgen");
  EXPECT_EQ(std::get<SignInBody>(read).secret, "123456");
}

TEST(PeopleBody, WhatIsTooLongForASignInIsNotHashed) {
  const auto body = [](std::size_t name, std::size_t secret) {
    return R"({"name":")" + std::string(name, 'n') + R"(","secret":")" + std::string(secret, 's') + "\"}";
  };
  EXPECT_TRUE(std::holds_alternative<SignInBody>(read_sign_in(body(64, 128))));
  EXPECT_TRUE(std::holds_alternative<Problem>(read_sign_in(body(65, 1))));
  EXPECT_TRUE(std::holds_alternative<Problem>(read_sign_in(body(1, 129))));
}

TEST(PeopleBody, ARefusalNamesThePlaceAndNoSecret) {
  struct Row {
    const char* body;
    const char* pointer;
  };
  for (const Row& row :
       {Row{R"({"name":"otto","role":"operate","secret":"hush"})", "/secret"},
        Row{R"({"name":"otto","role":"hush","secret":"hush hush"})", "/role"},
        Row{R"({"name":"","role":"view","secret":"hush hush"})", "/name"},
        Row{R"({"name":"otto","secret":"hush hush"})", "/role"},
        Row{R"({"name":"otto","role":"view","hush":"1"})", "/hush"}, Row{"\"hush\"", ""},
        Row{R"({"name":"otto","role":"view","secret":"hush hush","secret":"hush"})", ""}, Row{"hush", ""}}) {
    const auto read = read_user_request(row.body);
    ASSERT_TRUE(std::holds_alternative<Problem>(read)) << row.body;
    EXPECT_EQ(pointer_of(std::get<Problem>(read)), row.pointer) << row.body;
    EXPECT_EQ(std::get<Problem>(read).detail.find("hush hush"), std::string::npos) << row.body;
  }
}

TEST(PeopleBody, AUserWithoutASecretKeepsTheirs) {
  const auto read = read_user_request(R"({"name":"otto","role":"engineer"})");
  ASSERT_TRUE(std::holds_alternative<UserRequest>(read));
  EXPECT_EQ(std::get<UserRequest>(read).role, UserRole::kEngineer);
  EXPECT_EQ(std::get<UserRequest>(read).secret, std::nullopt);
}

TEST(PeopleBody, AChangeOfASecretHasBoth) {
  const auto read = read_secret_change(R"({"secret":"123456","new_secret":"another one"})");
  ASSERT_TRUE(std::holds_alternative<SecretChange>(read));
  EXPECT_EQ(std::get<SecretChange>(read).new_secret, "another one");
  EXPECT_TRUE(std::holds_alternative<Problem>(read_secret_change(R"({"secret":"123456"})")));
}

}  // namespace
}  // namespace cell
