#pragma once

#include <chrono>
#include <cstddef>
#include <map>
#include <mutex>
#include <optional>
#include <string>

#include "server/access/role.h"
#include "server/access/token.h"
#include "server/support/clock.h"

namespace vat {

class TokenStore;

enum class AccessMode {
  open,  ///< every connection becomes a controller
  token  ///< clients must send a token first
};
template <>
inline constexpr std::array kNamesOf<AccessMode>{"open", "token"};

struct AccessSettings {
  AccessMode mode = AccessMode::open;
  std::optional<TokenHash> admin;  ///< hash of the admin token; absent: none
  std::chrono::milliseconds enter_time{
      10'000};  ///< time for the token; the connection is closed afterwards
  std::chrono::milliseconds refusal_delay{1000};  ///< delay of the answer to a wrong token
  std::size_t max_wrong_tokens =
      3;  ///< number of wrong tokens after which the connection is closed
  std::chrono::seconds ticket_time{60};  ///< validity of a ticket
};

/// Access of a connection.
struct Grant {
  Role role = Role::none;
  std::string session;         ///< the only accessible session; empty: all
  bool is_invitation = false;  ///< the role replaces the session's default
};

/// Valid tokens, except the admin's. Safe to use from any thread.
class AccessTokens {
 public:
  /// `max_issued`: greatest number of issued tokens.
  AccessTokens(std::size_t max_issued, const Clock& clock)
      : max_issued_(max_issued), clock_(clock) {}

  /// Loads the tokens of the store, and stores issued tokens from now on. This and all functions
  /// that change stored tokens throw StorageError if the store cannot be written. They then change
  /// nothing.
  void keep_in(TokenStore& store);

  /// Returns a new token, valid for `uses` uses (absent: any number) and for `time`. Returns
  /// nothing if there are too many tokens.
  std::optional<std::string> issue(Grant grant, std::optional<std::size_t> uses,
                                   std::chrono::seconds time);
  /// Adds a token without expiry. The caller must remove it.
  void add(const TokenHash& token, Grant grant);
  void remove(const TokenHash& token);
  /// Removes the session's tokens. If `comes_back` is true (the session will be restored), issued
  /// tokens stay in the store.
  void remove_session(const std::string& session, bool comes_back);
  /// Returns the token's grant and counts the use, or returns nothing if the token is invalid.
  std::optional<Grant> use(const TokenHash& token);

 private:
  struct ValidToken {
    Grant grant;
    std::optional<std::size_t> uses;
    std::optional<SteadyClock::time_point> end;  // absent: not issued here
  };
  void remove_old();
  void count_use(const TokenHash& token, ValidToken& entry);

  const std::size_t max_issued_;
  const Clock& clock_;
  std::mutex mutex_;
  // By hash: the duration of a search depends on the hash, and does not reveal a token.
  std::map<TokenHash, ValidToken> entries_;
  std::size_t issued_ = 0;
  TokenStore* store_ = nullptr;  // null: tokens end with the server
};

}  // namespace vat
