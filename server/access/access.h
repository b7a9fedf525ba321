#pragma once

#include <chrono>
#include <cstddef>
#include <functional>
#include <map>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>

#include "server/access/role.h"
#include "server/access/shared_tokens.h"
#include "server/access/signed_token.h"
#include "server/access/token.h"
#include "server/storage/sqlite/storage_error.h"
#include "server/support/clock.h"

namespace vat {

class Journal;
class TokenStore;

enum class AccessMode {
  open,  ///< every connection gets the role controller
  token  ///< clients must send a token first
};
template <>
inline constexpr std::array kNamesOf<AccessMode>{"open", "token"};

struct AccessSettings {
  AccessMode mode = AccessMode::open;
  std::optional<TokenHash> admin;  ///< hash of the admin token; absent: no admin token
  /// Hash of the token for the metrics. Absent: only the admin token is valid for them, or none is
  /// needed in mode open.
  std::optional<TokenHash> metrics;
  /// Time limit for sending the token. The connection is closed afterwards.
  std::chrono::milliseconds enter_time{10'000};
  std::chrono::milliseconds refusal_delay{1000};  ///< delay of the reply to a wrong token
  /// Number of wrong tokens after which the connection is closed.
  std::size_t max_wrong_tokens = 3;
  std::chrono::seconds ticket_time{60};  ///< validity period of a ticket
};

/// Returns whether a request with this header Authorization ("Bearer TOKEN") may read the metrics.
bool may_read_metrics(const AccessSettings& settings, std::string_view authorization);

/// Access rights of a connection.
struct Grant {
  Role role = Role::none;
  std::string session;         ///< the only accessible session; empty: all sessions
  bool is_invitation = false;  ///< the role replaces the session's default role
};

/// Set of valid tokens, except the admin token. Thread-safe.
class AccessTokens {
 public:
  /// `max_issued` is the greatest number of issued tokens.
  AccessTokens(std::size_t max_issued, const Clock& clock)
      : max_issued_(max_issued), clock_(clock) {}

  /// Loads the tokens of the store, and stores all later changes by the journal. Throws
  /// StorageError.
  void keep_in(TokenStore& store, Journal& journal);
  /// Signs new tokens, and stores the issued ones in `shared` instead of the store. Call it before
  /// other functions.
  void share(SharedTokens& shared, TokenSigner signer);

  /// A new token, or the reason why there is none.
  struct Issued {
    std::optional<std::string> token;           ///< absent: too many tokens, or a failure
    std::optional<StorageError::Kind> failure;  ///< the token could not be stored
  };
  /// Calls `done` with a new token, valid for `uses` uses (absent: unlimited) and for `time`. If
  /// tokens are stored, calls `done` on another thread, otherwise before it returns.
  void issue(Grant grant, std::optional<std::size_t> uses, std::chrono::seconds time,
             std::function<void(Issued)> done);
  /// Returns a new token for a participant of the session. The caller must add() its hash.
  std::string make_resume(const std::string& session) const;
  /// Adds a token without expiry. The caller must remove it.
  void add(const TokenHash& token, Grant grant);
  void remove(const TokenHash& token);
  /// Removes the session's tokens. If `comes_back` is true (the session will be restored), the
  /// store retains the issued tokens.
  void remove_session(const std::string& session, bool comes_back);
  /// Use of a token.
  struct Use {
    Grant grant;
    std::optional<std::size_t> uses_left;        ///< absent: unlimited
    std::optional<SteadyClock::time_point> end;  ///< time of expiry; absent: token of add()
  };
  /// Returns the token's grant and counts the use, or returns nothing if the token is invalid. The
  /// caller must then call store_use().
  std::optional<Use> use(const TokenHash& token);
  /// Stores the use, so that the use counts even if the server ends. Calls `done` on the journal's
  /// thread, or before it returns if there is nothing to store. After a failure, the use does not
  /// count.
  void store_use(const TokenHash& token, const Use& use,
                 std::function<void(std::optional<StorageError::Kind>)> done);

  /// Returns whether the token can only be a signed one.
  bool is_signed(std::string_view token) const;
  /// Returns the content of a signed token, or nothing if the token is invalid.
  std::optional<TokenClaims> verify(std::string_view token) const;
  /// Calls `done` with the grant of a signed invitation or ticket, and counts the use. Calls `done`
  /// without a grant if the token is invalid. Calls it on another thread.
  struct SharedUse {
    std::optional<Grant> grant;
    std::optional<StorageError::Kind> failure;
  };
  void use_shared(const TokenHash& token, const TokenClaims& claims,
                  std::function<void(SharedUse)> done);

 private:
  struct ValidToken {
    Grant grant;
    std::optional<std::size_t> uses;
    std::optional<SteadyClock::time_point> end;  // time of expiry; absent: token of add()
  };
  void remove_old();
  /// Adds an issued token. Returns false if there are too many.
  bool insert(const TokenHash& hash, ValidToken token);
  void erase(const TokenHash& token);
  void undo(const TokenHash& token, const Use& use);
  /// Writes to the store in the background, if there is one. The caller must hold the mutex.
  template <class Write>
  void write(Write write);

  const std::size_t max_issued_;
  const Clock& clock_;
  std::mutex mutex_;
  // The key is the hash. The duration of a search depends only on the hash and does not reveal a
  // token.
  std::map<TokenHash, ValidToken> entries_;
  std::size_t issued_ = 0;
  TokenStore* store_ = nullptr;  // null: tokens are not stored
  Journal* journal_ = nullptr;
  SharedTokens* shared_ = nullptr;  // null: there are no other nodes
  std::optional<TokenSigner> signer_;
};

}  // namespace vat
