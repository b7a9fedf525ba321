#pragma once

#include <chrono>
#include <cstddef>
#include <map>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>

#include "server/access/role.h"
#include "server/access/token.h"
#include "server/clock.h"

namespace vat {

class TokenStore;

enum class AccessMode {
  open,  ///< whoever connects is let in, as a controller
  token  ///< a client has to show a token first
};
const char* to_string(AccessMode mode);

struct AccessSettings {
  AccessMode mode = AccessMode::open;
  std::optional<TokenHash> admin;                 ///< of the admin token; absent: there is none
  std::chrono::milliseconds enter_time{10'000};   ///< for the token; then the connection is closed
  std::chrono::milliseconds refusal_delay{1000};  ///< of the answer to a wrong token
  std::size_t max_wrong_tokens = 3;               ///< with so many the connection is closed
  std::chrono::seconds ticket_time{60};           ///< for which a ticket is good
};

/// What a client is let in with.
struct Grant {
  Role role = Role::none;
  std::string session;         ///< the only one that is open to it; empty: all are
  bool is_invitation = false;  ///< the role holds in the session, whatever is usual there
};

/// The tokens that are good now, but for the admin's. Safe to use from any thread.
class AccessTokens {
 public:
  /// At most so many that were issued are kept.
  AccessTokens(std::size_t max_issued, const Clock& clock)
      : max_issued_(max_issued), clock_(clock) {}

  /// From now on those that are issued are kept; those that are in the store are good again. Throws
  /// StorageError, as all do that change what is kept; nothing has changed then.
  void keep_in(TokenStore& store);

  /// A new token, valid for `uses` uses (absent: any number) and for `time`. Absent if there are
  /// too many tokens.
  std::optional<std::string> issue(Grant grant, std::optional<std::size_t> uses,
                                   std::chrono::seconds time);
  /// A token that somebody else looks after, good until it is removed.
  void add(const TokenHash& token, Grant grant);
  void remove(const TokenHash& token);
  /// Of a session that comes back, those that were issued are kept all the same.
  void remove_session(const std::string& session, bool comes_back);
  /// What the token gives, and counts the use; nothing if it is not good.
  std::optional<Grant> use(const TokenHash& token);

 private:
  struct Entry {
    Grant grant;
    std::optional<std::size_t> uses;
    std::optional<SteadyClock::time_point> end;  // absent: it was not issued here
  };
  void remove_old();
  void count_use(const TokenHash& token, Entry& entry);

  const std::size_t max_issued_;
  const Clock& clock_;
  std::mutex mutex_;
  // Found by their hashes: what the time of a search could tell is of the hash, not of the token.
  std::map<TokenHash, Entry> entries_;
  std::size_t issued_ = 0;
  TokenStore* store_ = nullptr;  // null: they end with the server
};

}  // namespace vat
