#pragma once

#include <cstdint>
#include <span>
#include <string>

#include "server/storage/sqlite/database.h"

namespace vat {

/// Schema of a database file, and upgrades from older versions.
struct Schema {
  std::uint32_t application = 0;  ///< identifies the kind of file
  /// SQL statements of each upgrade to the next version. An empty file has version 0, and the
  /// current version is the number of upgrades.
  std::span<const char* const> steps;
};

/// Journal of a database. See Database::use_log() and use_rollback().
enum class Journaling { write_ahead, rollback };

/// Opens a database of the current version. Creates a missing file, and upgrades an older version
/// in one transaction. Throws StorageError for a damaged, newer or unknown file, and does not
/// change the file.
Database open_database(const std::string& path, const Schema& schema, Durability durability,
                       Journaling journaling = Journaling::write_ahead);

/// Throws StorageError for a file that is damaged, newer, or of another program.
void inspect_database(const std::string& path, const Schema& schema);
/// Creates the tables of a version in an empty database. Must be called in a transaction. Throws
/// StorageError if there is no such version.
void create_schema(Database& database, const Schema& schema, std::int64_t version);

}  // namespace vat
