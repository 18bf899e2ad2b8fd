#include "service/base/digest.hpp"

#include <gtest/gtest.h>

namespace cell {
namespace {

TEST(Digest, IsThatOfTheStandard) {  // FIPS 180-4, the example "abc"
  EXPECT_EQ(sha256_hex("abc"), "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
}

}  // namespace
}  // namespace cell
