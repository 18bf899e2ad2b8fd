#include "service/http/auth/operator_tokens.hpp"

#include <gmock/gmock.h>
#include <sys/stat.h>

#include "service/base/state_directory.hpp"
#include "service/http/auth/token_file.hpp"
#include "service/http/auth/tokens.hpp"
#include "tests/config/folder.hpp"

namespace cell {
namespace {

using std::filesystem::perms;
using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::Field;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::SizeIs;

class OperatorTokens : public ::testing::Test {
 protected:
  OperatorTokens() {
    std::filesystem::create_directory(directory_);
    std::filesystem::permissions(directory_, perms::owner_all);
  }
  /// A file for its owner only.
  void write(const std::filesystem::path& file, const std::string& bytes) const {
    state_.write(file.lexically_relative(state_.path()).string(), bytes);
    std::filesystem::permissions(file, perms::owner_read | perms::owner_write);
  }
  /// What reading ends in; the start and the check of it end in the same.
  [[nodiscard]] std::string refusal() const {
    try {
      read_operator_tokens(state_.path());
    } catch (const std::runtime_error& error) {
      EXPECT_THROW(load_or_make_tokens(state_.path()), std::runtime_error);
      return error.what();
    }
    ADD_FAILURE() << "it was taken";
    return "";
  }

  const Folder state_;
  const std::filesystem::path directory_ = state_.path() / kOperatorsDirectory;
  const std::string token_ = "0f1e2d3c4b5a69788796a5b4c3d2e1f00f1e2d3c4b5a69788796a5b4c3d2e1f0";
};

TEST_F(OperatorTokens, EachIsNamedByItsFile) {
  write(directory_ / "bert-2", std::string(64, '2') + "\n");
  write(directory_ / "Anna_1", token_);
  const auto tokens = read_operator_tokens(state_.path());
  ASSERT_THAT(tokens, ElementsAre(Field(&NamedToken::name, "Anna_1"), Field(&NamedToken::name, "bert-2")));
  EXPECT_EQ(tokens[0].token, token_);
  EXPECT_EQ(tokens[1].token, std::string(64, '2')) << "its first line";
  const Tokens all = load_or_make_tokens(state_.path());
  EXPECT_THAT(all.operators, SizeIs(2));
  EXPECT_THAT(all.operate, SizeIs(64)) << "the token without a name is made as before";
}

TEST_F(OperatorTokens, AreNotAnotherUsers) {
  if (::geteuid() != 0) GTEST_SKIP() << "only root gives files away";
  write(directory_ / "anna", token_);
  ASSERT_EQ(::chown((directory_ / "anna").c_str(), 65534, 65534), 0);
  EXPECT_THAT(refusal(), HasSubstr("anna: belongs to another user"));
  ASSERT_EQ(::chown(directory_.c_str(), 65534, 65534), 0);
  EXPECT_THAT(refusal(), HasSubstr("operators: belongs to another user than the state directory"));
  ASSERT_EQ(::chown(state_.path().c_str(), 65534, 65534), 0);
  EXPECT_THAT(read_operator_tokens(state_.path()), SizeIs(1)) << "root looks at the directory of a service";
}

TEST_F(OperatorTokens, ThereNeedNotBeAny) {
  EXPECT_THAT(read_operator_tokens(state_.path()), IsEmpty());
  std::filesystem::remove(directory_);
  EXPECT_THAT(load_or_make_tokens(state_.path()).operators, IsEmpty());
  EXPECT_FALSE(std::filesystem::exists(directory_)) << "nor does the daemon make any";
}

TEST_F(OperatorTokens, ANameHasItsLettersAndItsLength) {
  write(directory_ / std::string(kTokenNameBytesMax, 'a'), token_);
  EXPECT_THAT(read_operator_tokens(state_.path()), SizeIs(1));
  for (const std::string& name :
       {std::string(kTokenNameBytesMax + 1, 'a'), std::string("anna.token"), std::string(".anna.swp"),
        std::string("anna b"), std::string("\u00e9mile")}) {
    const auto file = directory_ / name;
    write(file, std::string(64, '2'));
    EXPECT_THAT(refusal(), AllOf(HasSubstr(file.string()), HasSubstr("letters"), HasSubstr("rename")))
        << name;
    std::filesystem::remove(file);
  }
}

TEST_F(OperatorTokens, AFileIsHeldToTheRulesOfTheOtherTokens) {
  const auto file = directory_ / "anna";
  for (const std::string& bytes :
       {std::string(), std::string(63, '1'), std::string(1025, '1'), std::string(64, ' ')}) {
    write(file, bytes);
    EXPECT_THAT(refusal(), AllOf(HasSubstr(file.string() + ": does not hold a token"),
                                 HasSubstr("openssl rand -hex 32")));
  }
  write(file, token_);
  for (const perms others : {perms::group_read, perms::others_read, perms::others_write}) {
    std::filesystem::permissions(file, others, std::filesystem::perm_options::add);
    EXPECT_THAT(refusal(), AllOf(HasSubstr("chmod 600 " + file.string()), HasSubstr("write a new one")));
    std::filesystem::permissions(file, others, std::filesystem::perm_options::remove);
  }
  EXPECT_THAT(read_operator_tokens(state_.path()), SizeIs(1));
}

TEST_F(OperatorTokens, WhatIsNoFileIsRefused) {
  const auto place = directory_ / "anna";
  std::filesystem::create_directory(place);
  EXPECT_THAT(refusal(), HasSubstr(place.string() + ": is not a file"));
  std::filesystem::remove(place);
  std::filesystem::create_symlink("nowhere", place);
  EXPECT_THAT(refusal(), HasSubstr(place.string() + ": is not a file"));
}

TEST_F(OperatorTokens, APipeHoldsNobodyWhoReadsAndOfALargeFileOnlyTheBeginningIsRead) {
  const std::filesystem::path pipe = state_.path() / kOperateTokenFile, large = directory_ / "anna";
  ASSERT_EQ(::mkfifo(pipe.c_str(), S_IRUSR | S_IWUSR), 0);
  EXPECT_THROW(read_token(pipe, "remove it"), std::runtime_error);
  std::filesystem::remove(pipe);
  write(large, std::string(64, '1'));
  constexpr std::uintmax_t kTerabyte = 1'000'000'000'000;  // a sparse one
  std::filesystem::resize_file(large, kTerabyte);
  EXPECT_THAT(refusal(), HasSubstr("does not hold a token"));
}

TEST_F(OperatorTokens, OneTokenInTwoPlacesIsRefusedWithBoth) {
  write(directory_ / "anna", token_);
  write(directory_ / "bert", token_ + "\n");
  EXPECT_THAT(refusal(),
              AllOf(HasSubstr((directory_ / "anna").string()), HasSubstr((directory_ / "bert").string())));
  std::filesystem::remove(directory_ / "bert");
  for (const auto name : {kOperateTokenFile, kViewTokenFile}) {
    const auto other = state_.path() / name;
    write(other, token_);
    EXPECT_THAT(refusal(), AllOf(HasSubstr((directory_ / "anna").string()), HasSubstr(other.string())));
    std::filesystem::remove(other);
  }
}

TEST_F(OperatorTokens, TheyAreBounded) {
  for (std::size_t i = 0; i < kOperatorTokensMax; ++i)
    write(directory_ / std::to_string(i), token_ + std::to_string(i));
  EXPECT_THAT(read_operator_tokens(state_.path()), SizeIs(kOperatorTokensMax));
  write(directory_ / "one-more", std::string(64, '2'));
  EXPECT_THAT(refusal(),
              AllOf(HasSubstr(directory_.string()), HasSubstr("more than 32"), HasSubstr("remove")));
}

TEST_F(OperatorTokens, ADirectoryThatOthersMayWriteInIsRefused) {
  for (const perms others : {perms::group_write, perms::others_write}) {
    std::filesystem::permissions(directory_, others, std::filesystem::perm_options::add);
    EXPECT_THAT(refusal(), HasSubstr("chmod 700 " + directory_.string()));
    std::filesystem::permissions(directory_, others, std::filesystem::perm_options::remove);
  }
  std::filesystem::permissions(directory_, perms::others_read | perms::others_exec,
                               std::filesystem::perm_options::add);
  EXPECT_THAT(read_operator_tokens(state_.path()), IsEmpty()) << "names are no secret";
}

TEST_F(OperatorTokens, OfADaemonThatRunsWhatIsRefusedDoesNotCountAndTheOthersDo) {
  write(directory_ / "anna", token_);
  write(directory_ / "bert", std::string(64, '2'));
  write(directory_ / "cora", "short");
  const CurrentOperators now = operator_tokens_now(state_.path());
  ASSERT_THAT(now.tokens, ElementsAre(Field(&NamedToken::name, "anna"), Field(&NamedToken::name, "bert")));
  EXPECT_THAT(now.troubles, ElementsAre(HasSubstr("cora: does not hold a token")));
  std::filesystem::remove(directory_ / "anna");
  EXPECT_THAT(operator_tokens_now(state_.path()).tokens, ElementsAre(Field(&NamedToken::name, "bert")));
  std::filesystem::permissions(directory_, perms::group_write, std::filesystem::perm_options::add);
  EXPECT_THAT(operator_tokens_now(state_.path()).tokens, IsEmpty()) << "anybody may have put it there";
  EXPECT_THAT(operator_tokens_now(state_.path()).troubles, SizeIs(1));
}

TEST_F(OperatorTokens, OfADaemonThatRunsAFileThatCannotBeReadLeavesItsTokenAsItWas) {
  write(directory_ / "anna", token_);
  write(directory_ / "bert", std::string(64, '2'));
  const auto known = operator_tokens_now(state_.path()).tokens;
  std::filesystem::remove(directory_ / "anna");
  std::filesystem::create_symlink("/proc/self/mem", directory_ / "anna");  // reading it is an error
  const CurrentOperators now = operator_tokens_now(state_.path(), known);
  EXPECT_EQ(now.tokens, known);
  EXPECT_THAT(now.troubles, IsEmpty());
  EXPECT_THAT(now.kept, ElementsAre(HasSubstr("anna: the token cannot be read: Input/output error")));
  EXPECT_THAT(refusal(), HasSubstr("cannot be read")) << "no daemon starts with it";
  std::filesystem::remove(directory_ / "bert");
  std::filesystem::create_symlink("bert", directory_ / "bert");  // so is a loop
  write(directory_ / "cora", token_);
  const CurrentOperators later = operator_tokens_now(state_.path(), known);
  EXPECT_EQ(later.tokens, known);
  EXPECT_THAT(later.troubles, ElementsAre(HasSubstr("cora: holds the token of")))
      << "what is kept is held like what was read";
}

TEST_F(OperatorTokens, AFileInPlaceOfTheDirectoryIsRefused) {
  std::filesystem::remove(directory_);
  write(directory_, token_);
  EXPECT_THAT(refusal(), HasSubstr(directory_.string() + ": is not a directory"));
}

}  // namespace
}  // namespace cell
