#include "service/http/auth/tokens.hpp"

#include <gmock/gmock.h>
#include <sys/stat.h>

#include "service/base/state_directory.hpp"
#include "tests/config/folder.hpp"

namespace cell {
namespace {

using std::filesystem::perms;
using ::testing::HasSubstr;
using ::testing::MatchesRegex;

TEST(Tokens, TheFirstStartMakesTwoOf256RandomBits) {
  const Folder state;
  const Tokens tokens = load_or_make_tokens(state.path());
  const std::string hexadecimal = "^[0-9a-f]{64}$";
  EXPECT_THAT(tokens.operate, MatchesRegex(hexadecimal));
  EXPECT_THAT(tokens.view, MatchesRegex(hexadecimal));
  EXPECT_NE(tokens.operate, tokens.view);
  const Folder other;
  EXPECT_NE(load_or_make_tokens(other.path()).operate, tokens.operate);
}

TEST(Tokens, TheirFilesAreForTheirOwnerOnlyWhateverTheMask) {
  const Folder state;
  const mode_t before = umask(0);
  load_or_make_tokens(state.path());
  umask(before);
  for (const auto name : {kOperateTokenFile, kViewTokenFile}) {
    EXPECT_EQ(std::filesystem::status(state.path() / name).permissions(),
              perms::owner_read | perms::owner_write)
        << name;
  }
}

TEST(Tokens, TheNextStartReadsTheSame) {
  const Folder state;
  const Tokens first = load_or_make_tokens(state.path());
  const Tokens second = load_or_make_tokens(state.path());
  EXPECT_EQ(first.operate, second.operate);
  EXPECT_EQ(first.view, second.view);
  EXPECT_EQ(bytes_of(state.path() / kOperateTokenFile), first.operate + "\n");
}

TEST(Tokens, AFileThatOthersMayReadIsRefusedWithTheRemedy) {
  for (const perms others : {perms::group_read, perms::others_read, perms::others_write}) {
    const Folder state;
    load_or_make_tokens(state.path());
    const auto file = state.path() / kViewTokenFile;
    std::filesystem::permissions(file, others, std::filesystem::perm_options::add);
    try {
      load_or_make_tokens(state.path());
      ADD_FAILURE() << "took a token that others know";
    } catch (const std::runtime_error& error) {
      EXPECT_THAT(error.what(), HasSubstr("chmod 600 " + file.string()));
    }
  }
}

TEST(Tokens, AFileThatHoldsNoTokenIsRefusedByName) {
  for (const std::string& bytes :
       {std::string(), std::string("\n"), std::string("secret\n"), std::string(63, 'a') + "\n",
        "\n" + std::string(64, 'a'), std::string(64, '\0') + "\n", std::string(64, ' ') + "\n",
        std::string(63, 'a') + "\t\n"}) {
    const Folder state;
    const auto file = state.write(std::string(kOperateTokenFile), bytes);
    std::filesystem::permissions(file, perms::owner_read | perms::owner_write);
    try {
      load_or_make_tokens(state.path());
      ADD_FAILURE() << "took '" << bytes << "'";
    } catch (const std::runtime_error& error) {
      EXPECT_THAT(error.what(), HasSubstr(file.string()));
    }
  }
}

TEST(Tokens, AFolderThatIsNotThereIsToldWithTheFile) {
  const Folder state;
  try {
    load_or_make_tokens(state.path() / "gone");
    ADD_FAILURE() << "made tokens nowhere";
  } catch (const std::runtime_error& error) {
    EXPECT_THAT(error.what(), HasSubstr((state.path() / "gone" / kOperateTokenFile).string()));
  }
}

TEST(Tokens, OnlyTheWholeTokenIsTheToken) {
  const std::string token(64, 'a');
  EXPECT_TRUE(same_token(token, token));
  EXPECT_FALSE(same_token(token, ""));
  EXPECT_FALSE(same_token(token, token.substr(1)));
  EXPECT_FALSE(same_token(token, token + "a"));
  for (std::size_t i = 0; i < token.size(); ++i) {
    std::string other = token;
    other[i] = 'b';
    EXPECT_FALSE(same_token(token, other)) << i;
  }
}

}  // namespace
}  // namespace cell
