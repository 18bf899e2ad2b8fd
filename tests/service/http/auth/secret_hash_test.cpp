#include "service/http/auth/secret_hash.hpp"

#include <gtest/gtest.h>

#include <new>
#include <string>

#include "tests/service/http/auth/refused_memory.hpp"

namespace cell {
namespace {

TEST(SecretHash, IsOfItsSecretOnlyAndTellsNothingByBeingTheSame) {
  const std::string hash = hash_secret("123456");
  EXPECT_TRUE(is_secret_of(hash, "123456"));
  for (const char* other : {"123457", "12345", "1234567", "", " 123456"})
    EXPECT_FALSE(is_secret_of(hash, other)) << other;
  EXPECT_NE(hash, hash_secret("123456")) << "each has its salt";
  EXPECT_EQ(hash.find("123456"), std::string::npos);
  EXPECT_TRUE(is_secret_hash(hash));
}

TEST(SecretHash, WhatIsNoHashIsOfNoSecret) {
  const std::string hash = hash_secret("123456");
  std::string other_costs = hash;
  other_costs.replace(other_costs.find("m=65536"), 7, "m=99999");
  for (const std::string& text :
       {std::string(), std::string("123456"), std::string(500, 'a'), hash.substr(0, 40), other_costs}) {
    EXPECT_FALSE(is_secret_hash(text)) << text;
    EXPECT_FALSE(is_secret_of(text, "123456")) << text;
  }
  EXPECT_FALSE(is_secret_of(hash + "x", "123456"));
}

TEST(SecretHash, NobodysIsOfNoSecretThatCanBeTyped) {
  EXPECT_TRUE(is_secret_hash(hash_of_nobody()));
  EXPECT_EQ(hash_of_nobody(), hash_of_nobody());
  EXPECT_FALSE(is_secret_of(hash_of_nobody(), ""));
}

TEST(SecretHash, WithoutMemoryNothingIsSaidOfASecret) {
  const std::string hash = hash_secret("271828");
  {
    const RefusedMemory refused;
    EXPECT_THROW(hash_secret("271828"), std::bad_alloc);
    EXPECT_THROW(is_secret_of(hash, "271828"), std::bad_alloc) << "it is not wrong";
    EXPECT_FALSE(is_secret_of("no hash", "271828"));
    EXPECT_TRUE(is_secret_hash(hash_of_nobody()));
  }
  EXPECT_TRUE(is_secret_of(hash, "271828"));
}

/// Made by the reference implementation, argon2id_hash_encoded() of libargon2 20171227.
TEST(SecretHash, ReadsWhatOthersMakeOfArgon2id) {
  const std::string hash =
      "$argon2id$v=19$m=65536,t=2,p=1$dG91Y2hjYWwtdG91Y2hjYQ$5smb1bk3q6IIcYDjcuicntYVMIXEg/TV8nfpKUerqYw";
  EXPECT_TRUE(is_secret_of(hash, "271828"));
  EXPECT_FALSE(is_secret_of(hash, "271829"));
}

}  // namespace
}  // namespace cell
