#pragma once

#include <cstdint>
#include <span>
#include <string>

#include "server/storage/database.h"

namespace vat {

/// What a database file holds, and how older ones become what this program reads.
struct Schema {
  std::uint32_t application = 0;  ///< marks the file as one of this sort
  /// Statements that lead from each version to the next: an empty file has version 0, and this
  /// program reads the version that is their number.
  std::span<const char* const> steps;
};

/// Opens a database of the present version: makes it where there is none, and takes an older one
/// there, in one transaction. A file that is damaged, of another sort or newer is refused, and
/// stays as it is.
Database open_database(const std::string& path, const Schema& schema);

}  // namespace vat
