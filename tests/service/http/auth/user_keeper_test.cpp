#include "service/http/auth/user_keeper.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>

#include "service/base/utc_time.hpp"
#include "service/http/auth/secret_hash.hpp"
#include "tests/config/folder.hpp"

namespace cell {
namespace {

namespace fs = std::filesystem;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

constexpr std::chrono::system_clock::time_point kNow{std::chrono::hours(1)};

class UserKeeperTest : public ::testing::Test {
 protected:
  void make_users() {
    UserKeeper keeper(file_);
    const std::string hash = hash_secret("271828");
    keeper.change([&](UserBook& book) {
      put_user(
          book,
          {.name = "anna", .role = UserRole::kEngineer, .secret_hash = hash, .created_at = format_utc(kNow)});
      put_user(book, {.name = "Jürgen \"J\"",
                      .secret_hash = hash,
                      .created_at = format_utc(kNow),
                      .created_by = "anna"});
      begin_session(book, "anna", std::string(64, 'a'), kNow);
      return Effect::kGives;
    });
  }
  /// The disk takes nothing more, or does again.
  void fill_disk() const {
    fs::remove(file_);
    fs::create_directory(file_);  // cannot be replaced by a file
  }
  void free_disk() const { fs::remove(file_); }
  nlohmann::json document() const {
    std::ifstream in(file_);
    return nlohmann::json::parse(in);
  }
  void write(const std::string& text) const { std::ofstream(file_) << text; }
  std::string refusal() const {
    try {
      UserKeeper keeper(file_);
    } catch (const std::runtime_error& error) {
      return error.what();
    }
    return {};
  }

  Folder folder_;
  fs::path file_ = folder_.path() / "users.json";
};

TEST_F(UserKeeperTest, WhatIsChangedIsThereAfterARestart) {
  make_users();
  const UserBook book = UserKeeper(file_).book();
  ASSERT_EQ(book.users.size(), 2U);
  EXPECT_EQ(book.users[1].name, "anna");
  EXPECT_EQ(book.users[1].last_sign_in_at, format_utc(kNow));
  EXPECT_EQ(book.users[0].created_by, "anna");
  ASSERT_EQ(book.sessions.size(), 1U);
  EXPECT_EQ(book.sessions[0].role, UserRole::kEngineer);
  EXPECT_EQ(fs::status(file_).permissions(), fs::perms::owner_read | fs::perms::owner_write);
}

TEST_F(UserKeeperTest, NeitherSecretNorTokenStandsInTheFile) {
  make_users();
  const std::string text = document().dump();
  EXPECT_THAT(text, AllOf(HasSubstr("$argon2id$"), Not(HasSubstr("271828"))));
}

TEST_F(UserKeeperTest, WhatGivesIsNotChangedWhereItCannotBeWritten) {
  make_users();
  UserKeeper keeper(file_);
  const UserBook before = keeper.book();
  fill_disk();
  EXPECT_THROW(keeper.change([](UserBook& book) {
    put_user(book, {.name = "mallory"});
    return Effect::kGives;
  }),
               std::exception);
  EXPECT_EQ(keeper.book(), before);
}

TEST_F(UserKeeperTest, WhatTakesAwayCountsOnAFullDiskAndIsWrittenOnceItCanBe) {
  make_users();
  UserKeeper keeper(file_);
  fill_disk();
  const auto remove_anna = [](UserBook& book) {
    remove_user(book, "anna");
    return Effect::kTakes;
  };
  EXPECT_FALSE(keeper.change(remove_anna));
  EXPECT_EQ(find_user(keeper.book(), "anna"), nullptr);
  EXPECT_TRUE(keeper.book().sessions.empty());
  EXPECT_FALSE(keeper.keep());
  EXPECT_TRUE(keeper.change(remove_anna)) << "nothing is to be changed";
  free_disk();
  EXPECT_TRUE(keeper.keep());
  EXPECT_EQ(UserKeeper(file_).book(), keeper.book());
  EXPECT_TRUE(keeper.keep()) << "nothing is to be written";
}

TEST_F(UserKeeperTest, WhatTheDiskDidNotTakeIsWrittenWithTheNextChange) {
  make_users();
  UserKeeper keeper(file_);
  fill_disk();
  EXPECT_FALSE(keeper.change([](UserBook& book) {
    remove_user(book, "anna");
    return Effect::kTakes;
  }));
  free_disk();
  EXPECT_TRUE(keeper.change([](UserBook& book) {
    put_user(book, {.name = "cora", .secret_hash = hash_of_nobody(), .created_at = format_utc(kNow)});
    return Effect::kGives;
  }));
  EXPECT_EQ(UserKeeper(file_).book(), keeper.book());
}

TEST_F(UserKeeperTest, WithoutAFileAllIsInMemory) {
  UserKeeper keeper(std::nullopt);
  const auto put = [&](const char* name, Effect effect) {
    return keeper.change([&](UserBook& book) {
      put_user(book, {.name = name});
      return effect;
    });
  };
  EXPECT_TRUE(put("anna", Effect::kGives));
  EXPECT_TRUE(put("bert", Effect::kTakes));
  EXPECT_EQ(keeper.book().users.size(), 2U);
}

TEST_F(UserKeeperTest, AFileThatOthersMayReadIsRefusedWithTheRemedy) {
  make_users();
  fs::permissions(file_, fs::perms::group_read, fs::perm_options::add);
  EXPECT_THAT(refusal(), AllOf(HasSubstr(file_.string()), HasSubstr("chmod 600")));
}

TEST_F(UserKeeperTest, ADamagedFileIsRefusedWithItsPlaceAndTheRemedy) {
  make_users();
  const nlohmann::json whole = document();
  const auto with = [&](const char* pointer, const nlohmann::json& value) {
    nlohmann::json changed = whole;
    changed[nlohmann::json::json_pointer(pointer)] = value;
    write(changed.dump());
    return refusal();
  };
  for (const auto& [pointer, value] :
       std::initializer_list<std::pair<const char*, nlohmann::json>>{{"/schema", "touchcal/users-file/9"},
                                                                     {"/users/0/role", "owner"},
                                                                     {"/users/0/name", ""},
                                                                     {"/users/0/name", "anna"},
                                                                     {"/users/0/secret_hash", "271828"},
                                                                     {"/users/1/created_at", "yesterday"},
                                                                     {"/users/1/more", 1},
                                                                     {"/sessions/0/user", "cora"},
                                                                     {"/sessions/0/token_sha256", "abc"},
                                                                     {"/sessions/0/ends_at", 7}}) {
    EXPECT_THAT(with(pointer, value), AllOf(HasSubstr(file_.string()), HasSubstr("remove the file")))
        << pointer;
  }
  for (const char* text : {"", "{", "[]", "{\"schema\":\"touchcal/users-file/1\"}"}) {
    write(text);
    EXPECT_THAT(refusal(), HasSubstr(file_.string())) << text;
  }
  write(whole.dump());
  EXPECT_EQ(refusal(), "");
}

}  // namespace
}  // namespace cell
