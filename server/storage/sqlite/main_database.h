#pragma once

#include <mutex>
#include <string>

#include "server/storage/sqlite/database.h"

namespace vat {

/// Database of small data that must not be lost: sessions, their logs, hashes of tokens, and saved
/// scenes. The stores share the connection and lock the mutex during each use.
struct MainDatabase {
  /// Name of an in-memory database.
  static constexpr const char* kInMemory = ":memory:";

  /// Opens, creates or upgrades the database, see open_database().
  explicit MainDatabase(const std::string& path);

  std::mutex mutex;
  Database database;
};

}  // namespace vat
