#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>

/// Tokens for the access of clients. The server stores only hashes of tokens.
namespace vat {

/// SHA-256 hash of a token.
using TokenHash = std::array<std::uint8_t, 32>;

/// Returns 128 random bits as 22 characters of base64url (RFC 4648, without padding). Throws
/// std::runtime_error if the system cannot provide random bits.
std::string make_token();
TokenHash hash_of_token(std::string_view token);
/// Compares two hashes in constant time.
bool are_same(const TokenHash& a, const TokenHash& b);

}  // namespace vat
