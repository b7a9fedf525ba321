#pragma once

#include <mutex>
#include <string>

#include "server/storage/sqlite/database.h"
#include "server/storage/sqlite/schema.h"

namespace vat {

/// Database of small data that must not be lost: sessions, their logs, hashes of tokens, and saved
/// scenes. The stores share the connection and lock the mutex during each use. The journal locks
/// the mutex during a whole transaction, in which stores write.
struct MainDatabase {
  /// Name of an in-memory database.
  static constexpr const char* kInMemory = ":memory:";

  /// Opens, creates or upgrades the database, see open_database().
  explicit MainDatabase(const std::string& path, Durability durability = Durability::process);

  std::recursive_mutex mutex;
  Database database;
};

/// Returns the schema of the database.
Schema main_schema();

}  // namespace vat
