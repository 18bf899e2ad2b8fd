#include "service/http/auth/tokens.hpp"

#include <gmock/gmock.h>
#include <sys/fsuid.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

#include <csignal>

#include "service/base/state_directory.hpp"
#include "tests/config/folder.hpp"

namespace cell {
namespace {

using std::filesystem::perms;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::MatchesRegex;
using ::testing::SizeIs;

/// A thread whom the rights of files bind, also where the tests run as root.
class BoundByRights {
 public:
  BoundByRights() { ::setfsuid(kNobody); }
  ~BoundByRights() { ::setfsuid(::geteuid()); }
  BoundByRights(const BoundByRights&) = delete;
  BoundByRights& operator=(const BoundByRights&) = delete;

 private:
  static constexpr uid_t kNobody = 65534;
};

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

TEST(Tokens, WhoIsKilledAtTheWriteOfOneLeavesNoPartOfItToTheNextStart) {
  const Folder state;
  const auto be_killed = [&] {
    const rlimit nothing{.rlim_cur = 0, .rlim_max = 0};
    ::setrlimit(RLIMIT_FSIZE, &nothing);  // the first write to a file ends the process
    load_or_make_tokens(state.path());
  };
  EXPECT_EXIT(be_killed(), ::testing::KilledBySignal(SIGXFSZ), "");
  const Tokens made = load_or_make_tokens(state.path());
  EXPECT_EQ(load_or_make_tokens(state.path()).operate, made.operate);
  for (const auto& entry : std::filesystem::directory_iterator(state.path()))
    EXPECT_NE(entry.path().extension(), ".new") << "what was left is gone";
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
        std::string(63, 'a') + "\t\n", random_hex(31) + "\n"}) {
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

TEST(Tokens, AFileOfAnotherOwnerIsRefusedAlsoByRootUnlessTheDirectoryIsHisToo) {
  if (::geteuid() != 0) GTEST_SKIP() << "only root gives files away";
  constexpr uid_t kAnother = 65534;
  const Folder state;
  load_or_make_tokens(state.path());
  const auto file = state.path() / kOperateTokenFile;
  ASSERT_EQ(::chown(file.c_str(), kAnother, kAnother), 0);
  try {
    load_or_make_tokens(state.path());
    ADD_FAILURE() << "took somebody else's token";
  } catch (const std::runtime_error& error) {
    EXPECT_THAT(error.what(), HasSubstr(file.string() + ": belongs to another user than its directory"));
    EXPECT_THAT(error.what(), HasSubstr("chown --reference=" + state.path().string()));
  }
  ASSERT_EQ(::chown(state.path().c_str(), kAnother, kAnother), 0);
  EXPECT_NO_THROW(load_or_make_tokens(state.path())) << "root looks at the directory of a service";
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

class TokensOfARunningDaemon : public ::testing::Test {
 protected:
  void write(const std::filesystem::path& file, const std::string& bytes) const {
    state_.write(file.string(), bytes);
    std::filesystem::permissions(state_.path() / file, perms::owner_read | perms::owner_write);
  }
  CurrentTokens look() const { return tokens_now(KnownDirectory(state_.path()), known_); }

  const Folder state_;
  const Tokens known_ = load_or_make_tokens(state_.path());
  const std::vector<std::string_view> files_{kOperateTokenFile, kViewTokenFile};
};

TEST_F(TokensOfARunningDaemon, AreThoseOfTheFilesAsTheyAre) {
  EXPECT_EQ(look().tokens, known_);
  const Tokens others{random_hex(32), random_hex(32)};
  write(kOperateTokenFile, others.operate);
  write(kViewTokenFile, others.view + "\n");
  const CurrentTokens now = look();
  EXPECT_EQ(now.tokens, others);
  EXPECT_THAT(now.troubles, IsEmpty());
  EXPECT_THAT(now.kept, IsEmpty());
}

TEST_F(TokensOfARunningDaemon, AreMadeAnewWhereTheirFileWasRemoved) {
  for (const auto file : files_) std::filesystem::remove(state_.path() / file);
  const Tokens now = look().tokens;
  EXPECT_THAT(now.operate, SizeIs(64));
  EXPECT_NE(now.operate, known_.operate);
  EXPECT_NE(now.view, known_.view);
  EXPECT_EQ(load_or_make_tokens(state_.path()), now) << "they stand in their files";
}

TEST_F(TokensOfARunningDaemon, AreNobodysWhereTheirFileIsRefused) {
  write(kOperateTokenFile, "short");
  std::filesystem::permissions(state_.path() / kViewTokenFile, perms::group_read,
                               std::filesystem::perm_options::add);
  const CurrentTokens now = look();
  EXPECT_EQ(now.tokens, Tokens{});
  EXPECT_THAT(now.troubles, ElementsAre(HasSubstr("operate.token: does not hold a token"),
                                        HasSubstr("view.token: others than its owner have access")));
  EXPECT_THAT(now.kept, IsEmpty());
}

TEST_F(TokensOfARunningDaemon, AreNobodysWhereRightsKeepTheDaemonFromTheirFile) {
  const std::filesystem::path anna = std::filesystem::path(kOperatorsDirectory) / "anna";
  write(anna, std::string(64, '1'));
  for (const std::filesystem::path& directory : {state_.path(), state_.path() / kOperatorsDirectory})
    std::filesystem::permissions(directory, perms(0755));  // it is the files that are kept from it
  const Tokens known = look().tokens;
  ASSERT_THAT(known.operators, SizeIs(1));
  for (const std::filesystem::path& file :
       {std::filesystem::path(kOperateTokenFile), std::filesystem::path(kViewTokenFile), anna})
    std::filesystem::permissions(state_.path() / file, perms::none);
  const BoundByRights bound;
  const CurrentTokens now = tokens_now(KnownDirectory(state_.path()), known);
  EXPECT_EQ(now.tokens, Tokens{}) << "rights are somebody's decision";
  EXPECT_THAT(now.troubles,
              ElementsAre(HasSubstr("operate.token: the token cannot be read: Permission denied; make the "
                                    "file this user's own"),
                          HasSubstr("view.token: the token cannot be read"),
                          HasSubstr("anna: the token cannot be read: Permission denied")));
  EXPECT_THAT(now.kept, IsEmpty());
  EXPECT_THROW(load_or_make_tokens(state_.path()), std::runtime_error) << "nor does a daemon start with it";
}

TEST_F(TokensOfARunningDaemon, StayWhereTheirFileCannotBeReadOnce) {
  for (const auto file : files_) {
    std::filesystem::remove(state_.path() / file);
    // Where nothing is mapped: a regular file of its owner, whose reading is an error of the device.
    std::filesystem::create_symlink("/proc/self/mem", state_.path() / file);
  }
  const CurrentTokens now = look();
  EXPECT_EQ(now.tokens, known_);
  EXPECT_THAT(now.troubles, IsEmpty());
  EXPECT_THAT(now.kept, ElementsAre(HasSubstr("operate.token: the token cannot be read: Input/output error"),
                                    HasSubstr("view.token: the token cannot be read")));
  EXPECT_THAT(tokens_now(KnownDirectory(state_.path()), {}).troubles, SizeIs(2))
      << "where none is known none counts";
}

TEST_F(TokensOfARunningDaemon, StayWhereNoFileCanBeOpened) {
  std::filesystem::create_directory(state_.path() / kOperatorsDirectory);
  std::filesystem::permissions(state_.path() / kOperatorsDirectory, perms::owner_all);
  write(std::filesystem::path(kOperatorsDirectory) / "anna", std::string(64, '1'));
  const Tokens known = look().tokens;
  ASSERT_THAT(known.operators, SizeIs(1));
  rlimit before{};
  ASSERT_EQ(::getrlimit(RLIMIT_NOFILE, &before), 0);
  const rlimit none{.rlim_cur = 0, .rlim_max = before.rlim_max};
  ASSERT_EQ(::setrlimit(RLIMIT_NOFILE, &none), 0);
  const CurrentTokens now = tokens_now(KnownDirectory(state_.path()), known);
  ASSERT_EQ(::setrlimit(RLIMIT_NOFILE, &before), 0);
  EXPECT_EQ(now.tokens, known);
  EXPECT_THAT(now.troubles, IsEmpty());
  EXPECT_THAT(now.kept, SizeIs(3));
}

TEST_F(TokensOfARunningDaemon, AreAsTheyWereWhileTheWholeDirectoryIsGone) {
  write(std::filesystem::path(kOperatorsDirectory) / "anna", std::string(64, '1'));
  const Tokens known = look().tokens;
  const std::filesystem::path moved = state_.path().string() + "-moved";
  std::filesystem::rename(state_.path(), moved);
  const CurrentTokens now = tokens_now(KnownDirectory(state_.path()), known);
  std::filesystem::rename(moved, state_.path());
  EXPECT_EQ(now.tokens, known) << "STOP needs one";
  EXPECT_THAT(now.kept, SizeIs(1));
}

TEST_F(TokensOfARunningDaemon, AreAsTheyWereWhileAnotherDirectoryStandsInItsPlace) {
  const KnownDirectory own(state_.path());
  const std::filesystem::path moved = state_.path().string() + "-moved";
  std::filesystem::rename(state_.path(), moved);
  std::filesystem::create_directory(state_.path());
  const CurrentTokens beside_none = tokens_now(own, known_);
  EXPECT_TRUE(std::filesystem::is_empty(state_.path())) << "none are made for the stranger";
  write(kOperateTokenFile, std::string(64, '1'));
  write(std::filesystem::path(kOperatorsDirectory) / "anna", std::string(64, '2'));
  const CurrentTokens beside_others = tokens_now(own, known_);
  std::filesystem::remove_all(state_.path());
  std::filesystem::rename(moved, state_.path());
  for (const CurrentTokens& now : {beside_none, beside_others}) {
    EXPECT_EQ(now.tokens, known_);
    EXPECT_THAT(now.troubles, IsEmpty());
    EXPECT_THAT(now.kept, ElementsAre(HasSubstr("another stands in its place; move it back")));
  }
  EXPECT_THAT(tokens_now(own, known_).kept, IsEmpty());
}

TEST(Tokens, OnlyTheWholeTokenIsTheToken) {
  const std::string token(64, 'a');
  EXPECT_TRUE(same_token(token, token));
  EXPECT_FALSE(same_token(token, ""));
  EXPECT_FALSE(same_token("", "")) << "where there is no token nobody has it";
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
