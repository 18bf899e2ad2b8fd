#include "service/http/routes/internal/token_log.hpp"

#include <gmock/gmock.h>

#include <functional>
#include <string>

#include "tests/service/http/test_tokens.hpp"

namespace cell {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

/// What goes to the log meanwhile, which is standard output in a test.
std::string said(const std::function<void()>& by) {
  ::testing::internal::CaptureStdout();
  by();
  return ::testing::internal::GetCapturedStdout();
}

TEST(TokenLog, SaysATroubleOnceUntilItWasGone) {
  TokenTroubles troubles;
  const CurrentTokens trouble{.troubles = {"cora: is wrong"}, .kept = {"anna: cannot be read"}};
  const auto tell = [&] { troubles.tell(trouble); };
  EXPECT_THAT(said(tell),
              AllOf(HasSubstr("[error] cora: is wrong; what it is of does not count until then\n"),
                    HasSubstr("[warning] anna: cannot be read; what was read before counts until then\n")));
  EXPECT_EQ(said(tell), "");
  troubles.tell({});
  EXPECT_THAT(said(tell), AllOf(HasSubstr("cora"), HasSubstr("anna")));
}

TEST(TokenLog, SaysWhoseTokensCountAndNeverATokenItself) {
  Tokens now = kTokens;
  now.operate = std::string(64, 'f');
  now.view.clear();
  now.operators = {{"anna", std::string(64, 'c')}, kTokens.operators[1]};
  EXPECT_THAT(said([&] { tell_changes(kTokens, now); }),
              AllOf(HasSubstr("[info] the token that operate.token held does not count any more\n"),
                    HasSubstr("[info] another token in operate.token counts now\n"),
                    HasSubstr("[info] the token that view.token held does not count any more\n"),
                    Not(HasSubstr("another token in view.token")),
                    HasSubstr("[info] the operate token of anna does not count any more\n"),
                    HasSubstr("[info] an operate token of anna counts now\n"), Not(HasSubstr("bert")),
                    Not(HasSubstr("ffff")), Not(HasSubstr("cccc"))));
}

}  // namespace
}  // namespace cell
