#include "service/http/auth/access.hpp"

#include <gtest/gtest.h>

#include "tests/service/http/test_tokens.hpp"

namespace cell {
namespace {

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

}  // namespace
}  // namespace cell
