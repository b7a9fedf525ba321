#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "server/storage/main_database.h"

namespace vat {

/// What is kept of a token that lets somebody in.
struct StoredToken {
  std::array<std::uint8_t, 32> hash{};
  std::string role;
  std::string session;              ///< the only one that it is for; empty: all
  std::optional<std::size_t> uses;  ///< that are left; absent: any number
  double ends = 0;                  ///< [s] since 1970
};

/// The tokens that are good beyond the end of the server. Safe to use from any thread; throws
/// StorageError.
class TokenStore {
 public:
  explicit TokenStore(std::shared_ptr<MainDatabase> main) : main_(std::move(main)) {}

  void add(const StoredToken& token);
  void set_uses(std::span<const std::uint8_t> hash, std::size_t uses);
  void remove(std::span<const std::uint8_t> hash);
  void remove_session(const std::string& session);
  /// Removes those that have ended before.
  void remove_old(double now);
  std::vector<StoredToken> all();

 private:
  const std::shared_ptr<MainDatabase> main_;
};

}  // namespace vat
