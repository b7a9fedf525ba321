#pragma once

#include <cstdint>
#include <span>
#include <string>

#include "server/storage/sqlite/database.h"

namespace vat {

/// Content of a database file, and upgrades from older versions.
struct Schema {
  std::uint32_t application = 0;  ///< identifies the kind of file
  /// Statements that upgrade from each version to the next. An empty file has version 0; the
  /// current version is their number.
  std::span<const char* const> steps;
};

/// Opens a database of the current version. Creates a missing one, and upgrades an older one in one
/// transaction. Throws StorageError for a damaged, newer or other file, and leaves it unchanged.
Database open_database(const std::string& path, const Schema& schema);

}  // namespace vat
