#include "service/http/auth/user_book.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "service/base/utc_time.hpp"

namespace cell {
namespace {

using namespace std::chrono_literals;
using ::testing::ElementsAre;
using ::testing::Field;
using ::testing::Not;
using ::testing::SizeIs;

constexpr std::chrono::system_clock::time_point kNoon{12h};

User user(const std::string& name, UserRole role = UserRole::kOperate) {
  return {.name = name, .role = role, .secret_hash = "hash of " + name, .created_at = format_utc(kNoon)};
}

UserBook two() {
  UserBook book;
  put_user(book, user("bert"));
  put_user(book, user("anna", UserRole::kEngineer));
  begin_session(book, "anna", "digest a", kNoon);
  begin_session(book, "bert", "digest b", kNoon);
  return book;
}

TEST(UserBook, AUserIsThereOnceAndByName) {
  const UserBook book = two();
  EXPECT_THAT(book.users, ElementsAre(Field(&User::name, "anna"), Field(&User::name, "bert")));
  EXPECT_EQ(find_user(book, "anna")->role, UserRole::kEngineer);
  EXPECT_EQ(find_user(book, "Anna"), nullptr) << "names are compared exactly";
}

TEST(UserBook, WhoIsChangedKeepsTheirPastAndLosesTheirSessions) {
  UserBook book = two();
  User changed = user("anna", UserRole::kView);
  changed.created_at = format_utc(kNoon + 1h);
  changed.created_by = "bert";
  ASSERT_TRUE(put_user(book, changed));
  const User* anna = find_user(book, "anna");
  EXPECT_EQ(anna->role, UserRole::kView);
  EXPECT_EQ(anna->created_at, format_utc(kNoon));
  EXPECT_EQ(anna->created_by, std::nullopt);
  EXPECT_EQ(anna->last_sign_in_at, format_utc(kNoon));
  EXPECT_THAT(book.sessions, ElementsAre(Field(&Session::user, "bert")));
}

TEST(UserBook, WhoIsRemovedIsSignedOut) {
  UserBook book = two();
  EXPECT_TRUE(remove_user(book, "bert"));
  EXPECT_FALSE(remove_user(book, "bert"));
  EXPECT_THAT(book.sessions, ElementsAre(Field(&Session::user, "anna")));
  begin_session(book, "bert", "digest c", kNoon);
  EXPECT_THAT(book.sessions, SizeIs(1)) << "nobody of that name";
}

TEST(UserBook, AnotherSecretEndsAllSessionsButTheOneItWasChangedIn) {
  UserBook book = two();
  begin_session(book, "anna", "digest a2", kNoon);
  EXPECT_TRUE(change_secret(book, "anna", "other", "digest a2"));
  EXPECT_EQ(find_user(book, "anna")->secret_hash, "other");
  EXPECT_THAT(book.sessions, ElementsAre(Field(&Session::token_digest, "digest b"),
                                         Field(&Session::token_digest, "digest a2")));
  EXPECT_FALSE(change_secret(book, "cora", "other", ""));
}

TEST(UserBook, ASessionIsOverAtItsEndAndCountsUntilThen) {
  UserBook book = two();
  EXPECT_FALSE(is_over(book.sessions[0], kNoon + kSessionTime - 1ms));
  EXPECT_TRUE(is_over(book.sessions[0], kNoon + kSessionTime));
  EXPECT_EQ(session_count(book.sessions, "anna"), 1);
  book.sessions[0].is_over = true;
  EXPECT_EQ(session_count(book.sessions, "anna"), 0);
  EXPECT_EQ(session_count(book.sessions, "bert"), 1);
}

TEST(UserBook, TheOldestSessionOfAUserMakesRoom) {
  UserBook book = two();
  for (std::size_t i = 1; i < kSessionsOfUserMax + 1; ++i)
    begin_session(book, "anna", "next " + std::to_string(i), kNoon);
  EXPECT_EQ(session_count(book.sessions, "anna"), static_cast<int>(kSessionsOfUserMax));
  EXPECT_THAT(book.sessions, Not(::testing::Contains(Field(&Session::token_digest, "digest a"))));
  EXPECT_EQ(session_count(book.sessions, "bert"), 1);
}

TEST(UserBook, WhatIsLongOverIsForgottenAtASignIn) {
  UserBook book = two();
  begin_session(book, "anna", "new", kNoon + kSessionTime + kOverSessionKept);
  EXPECT_THAT(book.sessions, ElementsAre(Field(&Session::token_digest, "new")));
}

TEST(UserBook, HasABound) {
  UserBook book;
  for (std::size_t i = 0; i < kUsersMax; ++i) ASSERT_TRUE(put_user(book, user(std::to_string(i))));
  EXPECT_FALSE(put_user(book, user("one more")));
  EXPECT_TRUE(put_user(book, user("7", UserRole::kView))) << "is there";
}

TEST(UserBook, NamesAndSecretsThatCannotBe) {
  for (const std::string& name : {std::string("anna"), std::string("Jürgen Müller"), std::string(64, 'x')})
    EXPECT_EQ(why_no_user_name(name), std::nullopt) << name;
  for (const std::string& name :
       {std::string(), std::string(65, 'x'), std::string(" anna"), std::string("anna "), std::string(".."),
        std::string("an\nna"), std::string("an\x7fna")})
    EXPECT_NE(why_no_user_name(name), std::nullopt) << name;
  for (const std::string& secret : {std::string("271828"), std::string(127, 'x') + "y", std::string("süß 12"),
                                    std::string("123457"), std::string("112233"), std::string("abcdeg")})
    EXPECT_EQ(why_no_secret(secret, "anna"), std::nullopt) << secret;
  for (const std::string& secret : {std::string("12345"), std::string(129, 'y'), std::string("111111"),
                                    std::string("anna-maria"), std::string("12345\n")})
    EXPECT_NE(why_no_secret(secret, "anna-maria"), std::nullopt) << secret;
}

TEST(UserBook, ASecretThatIsTriedFirstIsRefusedAndToldWhy) {
  for (const char* secret : {"123456", "000000", "999999", "654321", "234567", "012345", "987654", "890123",
                             "210987", "1234567890", "0987654321", "abcdef", "fedcba", "aaaaaaaa"}) {
    EXPECT_THAT(why_no_secret(secret, "anna").value_or(""), ::testing::HasSubstr("first that is tried"))
        << secret;
  }
}

}  // namespace
}  // namespace cell
