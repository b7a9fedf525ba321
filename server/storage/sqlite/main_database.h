#pragma once

#include <mutex>
#include <string>

#include "server/storage/sqlite/database.h"

namespace vat {

/// Database of small data that must not be lost: sessions, their logs, hashes of tokens, saved
/// scenes. Its users share the connection and hold the mutex while they use it.
struct MainDatabase {
  /// Name of a database in memory.
  static constexpr const char* kInMemory = ":memory:";

  /// Opens, creates or upgrades it; see open_database().
  explicit MainDatabase(const std::string& path);

  std::mutex mutex;
  Database database;
};

}  // namespace vat
