#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <variant>

#include "server/access/signed_token.h"
#include "server/access/token.h"
#include "server/storage/sqlite/storage_error.h"

namespace vat {

/// Uses of the invitations and tickets that all nodes of a cluster share. The functions do not
/// wait, and call `done` on another thread. Thread-safe.
class SharedTokens {
 public:
  SharedTokens() = default;
  virtual ~SharedTokens() = default;
  SharedTokens(const SharedTokens&) = delete;
  SharedTokens& operator=(const SharedTokens&) = delete;

  /// Adds a new token with a number of uses (absent: unlimited).
  virtual void add(const TokenHash& token, const TokenClaims& claims,
                   std::optional<std::size_t> uses,
                   std::function<void(std::optional<StorageError::Kind>)> done) = 0;
  /// Counts a use. Calls `done` with false if there is no such token or no use is left. After a
  /// failure, the use may count.
  virtual void use(const TokenHash& token, const TokenClaims& claims,
                   std::function<void(std::variant<bool, StorageError::Kind>)> done) = 0;
  /// Removes the tokens of a session.
  virtual void remove_session(const std::string& session) = 0;
};

}  // namespace vat
