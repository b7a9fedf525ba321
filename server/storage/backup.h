#pragma once

#include <string>

namespace vat {

/// Writes a copy of the data folder to a new file. A server may use the folder meanwhile. The copy
/// has the state of one moment, with all commands that were answered before. Throws StorageError,
/// and then leaves no file.
void write_backup(const std::string& folder, const std::string& file);

/// Creates a data folder from a file of write_backup(). Throws StorageError if the folder contains
/// sessions, if a server uses it, or if the file is damaged or of a later version. The folder then
/// contains no sessions.
void restore_backup(const std::string& file, const std::string& folder);

}  // namespace vat
