#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include "server/access/role.h"

namespace vat {

/// Content of a signed token.
struct TokenClaims {
  enum class Kind {
    grant,  ///< invitation or ticket
    resume  ///< continues a participant
  };
  Kind kind = Kind::grant;
  Role role = Role::none;
  std::string session;     ///< the only accessible session; empty: all sessions
  std::uint64_t ends = 0;  ///< time of expiry [s since 1970]; 0: not limited by the time
};
template <>
inline constexpr std::array kNamesOf<TokenClaims::Kind>{"grant", "resume"};

/// Makes and verifies signed tokens with a secret key, which all nodes of a cluster have.
/// Thread-safe.
class TokenSigner {
 public:
  /// Least length of a key.
  static constexpr std::size_t kMinKeyBytes = 32;

  explicit TokenSigner(std::string key) : key_(std::move(key)) {}

  /// Returns a new token: base64url(JSON) "." base64url(HMAC-SHA256 of the first part). Two tokens
  /// with the same content differ.
  std::string sign(const TokenClaims& claims) const;
  /// Returns the content of a token, or nothing if its signature is wrong or it ended before the
  /// time `now` [s since 1970].
  std::optional<TokenClaims> verify(std::string_view token, double now) const;
  /// Returns whether the token has two parts. Other tokens cannot be signed.
  static bool has_signature(std::string_view token);

 private:
  std::string signature_of(std::string_view payload) const;

  const std::string key_;
};

}  // namespace vat
