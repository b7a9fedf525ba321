#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>

/// Secrets that clients show to be let in. The server keeps their hashes only.
namespace vat {

/// SHA-256.
using TokenHash = std::array<std::uint8_t, 32>;

/// 128 random bits of the system, as 22 characters of base64url (RFC 4648, without padding). Throws
/// std::runtime_error where the system has none.
std::string make_token();
TokenHash hash_of_token(std::string_view token);
/// In a time that does not depend on what they are.
bool are_same(const TokenHash& a, const TokenHash& b);

}  // namespace vat
