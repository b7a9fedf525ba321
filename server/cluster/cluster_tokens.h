#pragma once

#include <atomic>
#include <boost/asio/any_io_executor.hpp>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>

#include "server/access/shared_tokens.h"
#include "server/nats/bucket.h"
#include "server/support/clock.h"

namespace vat {

/// Bucket of a cluster with the uses of its invitations and tickets. A use requires the revision
/// that it replaces, so that two nodes cannot both grant the last use. The bucket contains the
/// hashes of the tokens, and no token.
class ClusterTokens final : public SharedTokens {
 public:
  /// `executor` runs work that waits. `instance` differs from the instances of other processes.
  /// The other arguments must outlive the bucket.
  ClusterTokens(NatsConnection& connection, boost::asio::any_io_executor executor,
                const Clock& clock, std::string instance);

  void add(const TokenHash& token, const TokenClaims& claims, std::optional<std::size_t> uses,
           std::function<void(std::optional<StorageError::Kind>)> done) override;
  void use(const TokenHash& token, const TokenClaims& claims,
           std::function<void(std::variant<bool, StorageError::Kind>)> done) override;
  void remove_session(const std::string& session) override;

 private:
  // These functions wait, and throw NatsError.
  /// Throws at once if there is no connection, so that clients get an answer soon.
  void require_connection() const;
  bool count_use(const std::string& key);
  /// Removes the tokens that ended since the previous call.
  void remove_old();

  std::string value_of(std::optional<std::size_t> uses);

  const NatsConnection& connection_;
  Bucket bucket_;
  const boost::asio::any_io_executor executor_;
  const Clock& clock_;
  const std::string instance_;
  std::atomic<std::uint64_t> writes_ = 0;
  std::atomic<std::uint64_t> removed_minutes_;  ///< tokens that ended before are removed
};

}  // namespace vat
