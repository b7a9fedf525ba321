#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "server/storage/sqlite/main_database.h"

namespace vat {

/// Stored data of an access token.
struct StoredToken {
  std::array<std::uint8_t, 32> hash{};
  std::string role;
  std::string session;              ///< the only accessible session; empty: all sessions
  std::optional<std::size_t> uses;  ///< remaining uses; absent: unlimited
  double ends = 0;                  ///< time of expiry [s since 1970]
};

/// Store of tokens that remain valid after the server ends. Thread-safe. Functions throw
/// StorageError.
class TokenStore {
 public:
  explicit TokenStore(std::shared_ptr<MainDatabase> main) : main_(std::move(main)) {}

  void add(const StoredToken& token);
  void set_uses(std::span<const std::uint8_t> hash, std::size_t uses);
  void remove(std::span<const std::uint8_t> hash);
  void remove_session(const std::string& session);
  /// Removes tokens that expired before the time `now`.
  void remove_old(double now);
  std::vector<StoredToken> all();

 private:
  const std::shared_ptr<MainDatabase> main_;
};

}  // namespace vat
