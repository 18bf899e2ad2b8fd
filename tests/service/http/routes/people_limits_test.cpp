// What holds people up and what does not: floods, memory, a full disk, a clock that is set.
#include <SQLiteCpp/SQLiteCpp.h>
#include <gmock/gmock.h>

#include <boost/asio/detached.hpp>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "service/base/state_directory.hpp"
#include "service/http/auth/hash_places.hpp"
#include "service/http/auth/user_keeper.hpp"
#include "tests/service/http/auth/refused_memory.hpp"
#include "tests/service/http/routes/people_bench.hpp"

namespace cell {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using namespace std::chrono_literals;
using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::Key;
using ::testing::Not;

class PeopleLimits : public SlowHashing {
 protected:
  Answered try_sign_in(const std::string& name, const std::string& secret,
                       const std::string& remote = "192.0.2.7") {
    return begin("", "/api/v1/sign-in", {{"name", name}, {"secret", secret}}, remote);
  }
  Answered put(const std::string& name, const std::string& role, const std::string& secret = "") {
    json body{{"name", name}, {"role", role}};
    if (!secret.empty()) body["secret"] = secret;
    return begin(kTokens.operate, "/api/v1/users", body);
  }
  Answered remove(const std::string& name) {
    return begin(kTokens.operate, "/api/v1/users/" + name + "/remove", json::object());
  }
  bool is_hash_waited_for() {
    hashing_.restart();
    return hashing_.poll() > 0;
  }
  unsigned command(const std::string& token, const std::string& path) {
    return status(begin(token, path, json::object()));
  }
  /// 202 for who operates, 401 for who is nobody.
  unsigned acknowledge(const std::string& token) { return command(token, "/api/v1/cell/acknowledge"); }
  static void expect_asked_again(const Answered& answered) {
    ASSERT_EQ(status(answered), 503U) << answered_text(answered);
    EXPECT_EQ((*answered)->content_type, "application/problem+json");
    EXPECT_THAT((*answered)->headers, Contains(Key("Retry-After")));
    EXPECT_EQ(json::parse(answered_text(answered)).at("type"), "urn:touchcal:problem:busy");
  }
  static std::string kind(const Answered& answered) {
    return json::parse(answered_text(answered)).value("type", "");
  }

  /// The disk does not take the users any more, or does again.
  void fill_disk() {
    fs::remove(users_file());
    fs::create_directory(users_file());
  }
  void free_disk() { fs::remove(users_file()); }
  fs::path users_file() { return quiet_.store().file().parent_path() / kUserFile; }
  UserRole role_of_user(const std::string& name) { return find_user(api_.services().user_book, name)->role; }
};

// floods

TEST_F(PeopleLimits, AFloodFromOneNetworkKeepsNobodyElsewhereFromSigningInAndNoTokenFromAnything) {
  const std::string otto = sign_in("otto");
  std::vector<Answered> flood;
  for (int i = 0; i < 10; ++i) flood.push_back(try_sign_in("made up " + std::to_string(i), "a guess"));
  for (std::size_t i = 0; i < flood.size(); ++i) {
    if (i < HashPlaces::kOfNetwork) {
      EXPECT_EQ(status(flood[i]), 0U) << "it is hashed";
    } else {
      expect_asked_again(flood[i]);
    }
  }
  const Answered eva = try_sign_in("eva", "271828", "198.51.100.1");
  const Answered other = try_sign_in("eva", "271828", "198.51.100.2");
  expect_asked_again(try_sign_in("eva", "271828", "198.51.100.3"));
  const Answered added = put("cora", "view", "314159");
  EXPECT_EQ(command(otto, "/api/v1/cell/stop"), 202U);
  EXPECT_EQ(acknowledge(otto), 202U);
  for (int i = 0; i < HashPlaces::kOfNetwork + 3; ++i) hash_one();
  EXPECT_EQ(status(eva), 201U);
  EXPECT_EQ(status(other), 201U);
  EXPECT_EQ(status(added), 201U);
  EXPECT_EQ(status(flood[0]), 401U);
}

TEST_F(PeopleLimits, MadeUpNamesAreRefusedBeforeTheyCostAHashAndNobodyLearnsWhichNamesThereAre) {
  for (int i = 0; i < GuessCounts::kAtOnce; ++i) {
    const Answered answered = try_sign_in("made up " + std::to_string(i), "a guess");
    hash_one();
    EXPECT_EQ(status(answered), 401U);
  }
  const Answered made_up = try_sign_in("one more", "a guess"), there = try_sign_in("otto", "a guess");
  EXPECT_FALSE(is_hash_waited_for());
  EXPECT_EQ(status(made_up), 429U);
  EXPECT_THAT((*made_up)->headers, Contains(Key("Retry-After")));
  EXPECT_EQ(answered_text(made_up), answered_text(there));
  const Answered elsewhere = try_sign_in("otto", "271828", "198.51.100.1");
  hash_one();
  EXPECT_EQ(status(elsewhere), 201U);
  time_.pass(GuessCounts::kForgetOne);
  sign_in("otto");
}

TEST_F(PeopleLimits, WhoHasSignedInFromThereIsNotHeldUpByMadeUpNames) {
  sign_in("eva");
  for (int i = 0; i < GuessCounts::kAtOnce; ++i) {
    try_sign_in("made up " + std::to_string(i), "a guess");
    hash_one();
  }
  ASSERT_EQ(status(try_sign_in("one more", "a guess")), 429U);
  sign_in("eva");
}

// memory

TEST_F(PeopleLimits, WithoutMemoryASignInIsNoWrongGuess) {
  for (int i = 0; i < 2 * GuessCounts::kAtOnce; ++i) {
    const RefusedMemory refused;
    const Answered otto = try_sign_in("otto", "271828");
    hash_one();
    expect_asked_again(otto);
    const Answered nobody = try_sign_in("made up " + std::to_string(i), "271828");
    hash_one();
    expect_asked_again(nobody);
  }
  sign_in("otto");
}

TEST_F(PeopleLimits, WithoutMemoryNoSecretIsMade) {
  const std::string otto = sign_in("otto");
  const json change{{"secret", "271828"}, {"new_secret", "another one"}};
  {
    const RefusedMemory refused;
    const Answered added = put("cora", "view", "271828");
    hash_one();
    expect_asked_again(added);
    const Answered changed = begin(otto, "/api/v1/session/secret", change);
    hash_one();
    expect_asked_again(changed);
  }
  const Answered changed = begin(otto, "/api/v1/session/secret", change);
  hash_one();  // the old one is right
  {
    const RefusedMemory refused;
    hash_one();
  }
  expect_asked_again(changed);
  EXPECT_EQ(users(), (std::vector<std::string>{"eva", "otto"}));
  sign_in("otto");  // by the secret that stayed
}

// a full disk

TEST_F(PeopleLimits, WhatTakesAwayCountsOnAFullDiskAndIsSaidNotToBeKept) {
  const std::string otto = sign_in("otto"), eva = sign_in("eva"), again = sign_in("eva");
  fill_disk();
  const Answered out = begin(eva, "/api/v1/sign-out", json::object());
  EXPECT_EQ(status(out), 503U);
  EXPECT_EQ(kind(out), "urn:touchcal:problem:not-kept");
  EXPECT_THAT(answered_text(out), HasSubstr("free space on the disk"));
  EXPECT_THAT((*out)->headers, Not(Contains(Key("Retry-After")))) << "there is nothing to be sent again";
  EXPECT_EQ(acknowledge(eva), 401U);
  EXPECT_EQ(acknowledge(again), 202U) << "another browser";

  EXPECT_EQ(kind(put("eva", "view")), "urn:touchcal:problem:not-kept");
  EXPECT_EQ(role_of_user("eva"), UserRole::kView);
  EXPECT_EQ(acknowledge(again), 401U);

  EXPECT_EQ(kind(remove("otto")), "urn:touchcal:problem:not-kept");
  EXPECT_EQ(users(), std::vector<std::string>{"eva"});
  EXPECT_EQ(acknowledge(otto), 401U);
  EXPECT_EQ(status(remove("otto")), 404U);
}

TEST_F(PeopleLimits, WhatGivesNeedsTheDisk) {
  fill_disk();
  const Answered raised = put("otto", "engineer");
  EXPECT_EQ(kind(raised), "urn:touchcal:problem:audit");
  EXPECT_THAT(answered_text(raised), HasSubstr("nothing was changed"));
  EXPECT_EQ(role_of_user("otto"), UserRole::kOperate);
  const Answered added = put("cora", "view", "271828");
  hash_one();
  EXPECT_EQ(kind(added), "urn:touchcal:problem:audit");
  EXPECT_EQ(users(), (std::vector<std::string>{"eva", "otto"}));
  const Answered signed_in = try_sign_in("otto", "271828");
  hash_one();
  EXPECT_EQ(kind(signed_in), "urn:touchcal:problem:audit");
}

TEST_F(PeopleLimits, WhatTheDiskDidNotTakeIsWrittenWhenItDoesAgain) {
  fill_disk();
  EXPECT_EQ(kind(remove("otto")), "urn:touchcal:problem:not-kept");
  free_disk();
  boost::asio::co_spawn(quiet_.context(), api_.follow_users(0ms), boost::asio::detached);
  quiet_.context().restart();
  while (!fs::exists(users_file())) ASSERT_EQ(quiet_.context().run_one(), 1U);
  EXPECT_EQ(UserKeeper(users_file()).book(), api_.services().user_book);
}

TEST_F(PeopleLimits, WhatCannotBeRecordedIsDoneWhereItTakesAwayOnly) {
  quiet_.store().database()->exec("DROP TABLE audit");
  EXPECT_EQ(status(put("eva", "operate")), 201U);
  EXPECT_EQ(status(remove("otto")), 200U);
  EXPECT_EQ(users(), std::vector<std::string>{"eva"});
  const Answered raised = put("eva", "engineer"), added = put("cora", "view", "271828");
  hash_one();
  const Answered renewed = put("eva", "view", "314159");
  hash_one();
  for (const Answered& answered : {raised, added, renewed}) {
    EXPECT_EQ(status(answered), 503U);
    EXPECT_THAT(answered_text(answered), HasSubstr("cannot be recorded"));
  }
  EXPECT_EQ(role_of_user("eva"), UserRole::kOperate);
  EXPECT_EQ(users(), std::vector<std::string>{"eva"});
}

// the clock

TEST_F(PeopleLimits, ASessionLastsTenHoursThoughTheClockThatDatesItStands) {
  const std::string otto = sign_in("otto");
  const auto look = [&] { api_.take_tokens(api_.services().tokens); };
  time_.pass(kSessionTime - 1ms);
  look();
  EXPECT_EQ(acknowledge(otto), 202U);
  time_.pass(1ms);
  look();
  EXPECT_EQ(acknowledge(otto), 401U);
  EXPECT_EQ(command(otto, "/api/v1/cell/stop"), 202U);
}

}  // namespace
}  // namespace cell
