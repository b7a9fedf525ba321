#include "server/access/token.h"

#include <openssl/crypto.h>
#include <openssl/sha.h>
#include <sys/random.h>

#include <stdexcept>

namespace vat {
namespace {

constexpr std::size_t kTokenBytes = 16;
constexpr std::string_view kAlphabet =
    "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789-_";

const std::uint8_t* bytes_of(std::string_view text) {
  return reinterpret_cast<const std::uint8_t*>(text.data());
}

}  // namespace

std::string make_token() {
  std::array<std::uint8_t, kTokenBytes> random{};
  // Whole or not at all: so few bytes are never cut short.
  if (getrandom(random.data(), random.size(), 0) != static_cast<ssize_t>(random.size())) {
    throw std::runtime_error("the system gives no random bytes");
  }
  std::string token;
  std::uint32_t bits = 0;
  int count = 0;
  for (const std::uint8_t byte : random) {
    bits = (bits << 8) | byte;
    for (count += 8; count >= 6; count -= 6) token += kAlphabet[(bits >> (count - 6)) & 63];
  }
  token += kAlphabet[(bits << (6 - count)) & 63];
  return token;
}

TokenHash hash_of_token(std::string_view token) {
  TokenHash hash{};
  SHA256(bytes_of(token), token.size(), hash.data());
  return hash;
}

bool are_same(const TokenHash& a, const TokenHash& b) {
  return CRYPTO_memcmp(a.data(), b.data(), a.size()) == 0;
}

}  // namespace vat
