#include "service/http/auth/secret_hash.hpp"

#include <gtest/gtest.h>

#include <string>

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

}  // namespace
}  // namespace cell
