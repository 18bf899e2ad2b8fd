#include "service/http/auth/access.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "service/base/digest.hpp"
#include "tests/service/http/test_tokens.hpp"

namespace cell {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::StartsWith;

HttpRequest with_token(const std::string& token, bool from_loopback = false) {
  return {.authorization = "Bearer " + token, .from_loopback = from_loopback};
}

TEST(Access, ATokenHasOneRole) {
  EXPECT_EQ(role_of(with_token(kTokens.operate), kTokens), Role::kOperate);
  EXPECT_EQ(role_of(with_token(kTokens.view), kTokens), Role::kView);
  EXPECT_EQ(role_of(with_token("other"), kTokens), Role::kWrongToken);
  EXPECT_EQ(role_of({}, kTokens), Role::kNone);
}

TEST(Access, ATokenWithANameOperatesUnderItsName) {
  for (const NamedToken& named : kTokens.operators) {
    const Caller caller = caller_of(with_token(named.token), kTokens);
    EXPECT_EQ(caller.role, Role::kOperate);
    EXPECT_EQ(caller.token_name, named.name);
    EXPECT_FALSE(refuse_access(with_token(named.token), Access::kOperate, kTokens));
  }
  for (const std::string& token : {kTokens.operate, kTokens.view, std::string("anna"), std::string()})
    EXPECT_EQ(caller_of(with_token(token), kTokens).token_name, "") << token;
}

TEST(Access, TheNameOfTheSchemeMayBeInAnyCase) {
  for (const char* scheme : {"bearer ", "BEARER ", "Bearer "})
    EXPECT_EQ(role_of({.authorization = scheme + kTokens.operate}, kTokens), Role::kOperate) << scheme;
  for (const char* scheme : {"Basic ", "Bearer", "bearer  ", ""})
    EXPECT_EQ(role_of({.authorization = scheme + kTokens.operate}, kTokens), Role::kWrongToken) << scheme;
}

TEST(Access, ABodyThatIsOnlyAnnouncedHasItsTypeToo) {
  EXPECT_FALSE(refuse_content_type({}));
  EXPECT_EQ(refuse_content_type({.announces_body = true}).value().status, 415U);
  EXPECT_FALSE(refuse_content_type({.content_type = "application/json", .announces_body = true}));
}

TEST(Access, ReadingNeedsATokenFromElsewhereOnlyAndOperatingAlways) {
  EXPECT_FALSE(refuse_access({.from_loopback = true}, Access::kView, kTokens));
  EXPECT_EQ(refuse_access({}, Access::kView, kTokens).value().status, 401U);
  EXPECT_FALSE(refuse_access(with_token(kTokens.view), Access::kView, kTokens));
  EXPECT_EQ(refuse_access(with_token(kTokens.view), Access::kOperate, kTokens).value().status, 403U);
  EXPECT_EQ(refuse_access({.from_loopback = true}, Access::kOperate, kTokens).value().status, 401U);
  EXPECT_FALSE(refuse_access(with_token(kTokens.operate), Access::kOperate, kTokens));
  EXPECT_FALSE(refuse_access({}, Access::kOpen, kTokens));
}

/// Tokens of three who have signed in, of one whose session is over, and those in files.
Tokens with_sessions() {
  Tokens tokens = kTokens;
  const auto add = [&](const std::string& name, UserRole role, bool is_over = false) {
    tokens.sessions.push_back({.token_digest = sha256_hex("token of " + name),
                               .user = name,
                               .role = role,
                               .ends_at = "2026-01-31T08:15:30.000Z",
                               .is_over = is_over});
  };
  add("vera", UserRole::kView);
  add("otto", UserRole::kOperate);
  add("eva", UserRole::kEngineer);
  add("gone", UserRole::kEngineer, true);
  return tokens;
}

TEST(Access, EachUserMayWhatTheirRoleMayAndWhoeverSignedInMayStop) {
  const Tokens tokens = with_sessions();
  const auto may = [&](const std::string& token, Access access) {
    return !refuse_access(with_token(token), access, tokens);
  };
  struct Row {
    std::string token;
    bool stop, view, operate, engineer;
  };
  for (const Row& row :
       {Row{"token of vera", true, true, false, false}, Row{"token of otto", true, true, true, false},
        Row{"token of eva", true, true, true, true}, Row{"token of gone", true, false, false, false},
        Row{"token of nobody", false, false, false, false}, Row{kTokens.view, false, true, false, false},
        Row{kTokens.operate, true, true, true, true},
        Row{kTokens.operators.front().token, true, true, true, true}}) {
    EXPECT_EQ(may(row.token, Access::kStop), row.stop) << row.token;
    EXPECT_EQ(may(row.token, Access::kView), row.view) << row.token;
    EXPECT_EQ(may(row.token, Access::kOperate), row.operate) << row.token;
    EXPECT_EQ(may(row.token, Access::kEngineer), row.engineer) << row.token;
  }
}

TEST(Access, ASessionTellsItsUserAndWhatItLacks) {
  const Tokens tokens = with_sessions();
  const Caller otto = caller_of(with_token("token of otto"), tokens);
  EXPECT_EQ(otto.token_name, "otto");
  EXPECT_TRUE(otto.is_user);
  EXPECT_EQ(role_name(otto.role), "operate");
  EXPECT_EQ(caller_of(with_token("token of gone"), tokens).role, Role::kOverSession);
  const auto detail = [&](const std::string& token, Access access) {
    const auto refused = refuse_access(with_token(token), access, tokens);
    return refused ? std::to_string(refused->status) + refused->body : std::string();
  };
  EXPECT_THAT(detail("token of otto", Access::kEngineer),
              AllOf(StartsWith("403"), HasSubstr("'otto' has the role operate")));
  EXPECT_THAT(detail("token of vera", Access::kOperate),
              AllOf(StartsWith("403"), HasSubstr("it may look and stop")));
  EXPECT_THAT(detail("token of gone", Access::kOperate),
              AllOf(StartsWith("401"), HasSubstr("is over"), HasSubstr("sign in again")));
  EXPECT_THAT(detail("token of nobody", Access::kOperate), HasSubstr("POST /api/v1/sign-in"));
}

}  // namespace
}  // namespace cell
