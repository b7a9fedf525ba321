#include "server/access/token.h"

#include <gtest/gtest.h>

#include <set>

namespace vat::token_test {
namespace {

std::string to_hex(const TokenHash& hash) {
  std::string text;
  for (const std::uint8_t byte : hash) {
    for (const int digit : {byte >> 4, byte & 15}) text += "0123456789abcdef"[digit];
  }
  return text;
}

// FIPS 180-2, appendix B.1.
TEST(Token, IsHashedBySha256) {
  EXPECT_EQ(to_hex(hash_of_token("abc")),
            "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
}

TEST(Token, HashesAreTheSameOrNot) {
  const TokenHash hash = hash_of_token("abc");
  for (std::size_t i = 0; i < hash.size(); ++i) {
    TokenHash other = hash;
    EXPECT_TRUE(are_same(hash, other));
    other[i] ^= 1;
    EXPECT_FALSE(are_same(hash, other)) << i;
  }
}

// All 22 characters vary: the last has 2 bits left, the others 6. With 4096 tokens the chance that
// some value of a character is missed is below 22 * 64 * exp(-4096 / 64), about 1e-25.
TEST(Token, IsOfRandomCharactersAndNeverTheSame) {
  std::set<std::string> tokens;
  std::vector<std::set<char>> seen(22);
  for (int i = 0; i < 4096; ++i) {
    const std::string token = make_token();
    ASSERT_EQ(token.size(), 22u);
    for (std::size_t c = 0; c < token.size(); ++c) seen[c].insert(token[c]);
    tokens.insert(token);
  }
  EXPECT_EQ(tokens.size(), 4096u);
  for (std::size_t c = 0; c < 21; ++c) EXPECT_EQ(seen[c].size(), 64u) << c;
  EXPECT_EQ(seen[21].size(), 4u);
}

}  // namespace
}  // namespace vat::token_test
