#pragma once

#include <mutex>
#include <string>

#include "server/storage/database.h"

namespace vat {

/// The database of all that is small and must not be lost: sessions and their logs, the hashes of
/// tokens, scenes that users have saved. Its parts share the connection, and the mutex that whoever
/// uses it holds.
struct MainDatabase {
  /// The name of one that is in memory alone.
  static constexpr const char* kInMemory = ":memory:";

  /// Opens it, or makes it, or takes an older one to the present version; see open_database().
  explicit MainDatabase(const std::string& path);

  std::mutex mutex;
  Database database;
};

}  // namespace vat
