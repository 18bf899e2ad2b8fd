#include "service/documents/people_document.hpp"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "service/documents/document_error.hpp"

namespace cell {
namespace {

using nlohmann::json;

TEST(PeopleDocument, UsersAreReadAsTheyAreWritten) {
  const UsersDocument written{.users = {{.name = "Jürgen",
                                         .role = "engineer",
                                         .created_at = "2026-01-31T08:15:30.000Z",
                                         .last_sign_in_at = "2026-02-01T08:15:30.000Z",
                                         .session_count = 2},
                                        {.name = "otto", .role = "view", .created_by = "Jürgen"}}};
  const UsersDocument read = read_users(document_text(written));
  ASSERT_EQ(read.users.size(), 2U);
  EXPECT_EQ(read.users[0].name, "Jürgen");
  EXPECT_EQ(read.users[0].last_sign_in_at, written.users[0].last_sign_in_at);
  EXPECT_EQ(read.users[0].session_count, 2);
  EXPECT_EQ(read.users[1].created_by, "Jürgen");
  EXPECT_THROW(read_users(R"({"schema":"touchcal/users/1"})"), DocumentError);
}

TEST(PeopleDocument, NobodyIsNullAndNotAbsent) {
  const json session = json::parse(document_text(SessionDocument{}));
  EXPECT_EQ(session, json::parse(R"({"schema":"touchcal/session/1","name":null,"role":"none","kind":"none",
                                     "ends_at":null,"sign_in":false})"));
}

TEST(PeopleDocument, ASecretThatStaysIsNotSent) {
  EXPECT_FALSE(
      json::parse(document_text(UserRequestDocument{.name = "otto", .role = "view"})).contains("secret"));
  EXPECT_EQ(
      json::parse(document_text(UserRequestDocument{.name = "otto", .role = "view", .secret = "123456"}))
          .at("secret"),
      "123456");
}

}  // namespace
}  // namespace cell
