#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>

/// Tokens by which clients get access. The server stores only their hashes.
namespace vat {

/// SHA-256.
using TokenHash = std::array<std::uint8_t, 32>;

/// Returns 128 random bits as 22 characters of base64url (RFC 4648, without padding). Throws
/// std::runtime_error if the system provides none.
std::string make_token();
TokenHash hash_of_token(std::string_view token);
/// Compares in constant time.
bool are_same(const TokenHash& a, const TokenHash& b);

}  // namespace vat
