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

/// Opens a database of the current version. Creates a missing file, and upgrades an older version
/// in one transaction. Throws StorageError for a damaged, newer or unknown file, and does not
/// change the file.
Database open_database(const std::string& path, const Schema& schema, Durability durability);

}  // namespace vat
