#pragma once

#include <fstream>
#include <string>
#include <string_view>

#include "server/storage/checkpoint_store.h"
#include "server/storage/saved/saved_state_database.h"
#include "server/storage/session_store.h"
#include "server/storage/sqlite/storage_error.h"
#include "tests/fuzz/target.h"

namespace vat::fuzz {

inline void write_file(const std::string& path, const std::uint8_t* data, std::size_t size) {
  std::ofstream file(path, std::ios::binary);
  file.write(reinterpret_cast<const char*>(data), static_cast<std::streamsize>(size));
  VAT_CHECK(file.good());
}

/// Damaged data must be reported as such, not as a fault of the disk. SQLite reports a damaged size
/// as lack of memory, and a damaged version of the file format as a read-only file.
inline void check_reason(const StorageError& error) {
  using enum StorageError::Kind;
  VAT_CHECK(error.kind() == corrupt || error.kind() == newer || error.kind() == read_only ||
            std::string_view(error.what()).ends_with("out of memory"));
}

/// Reads all that a recovery reads from the databases of a data folder. Throws StorageError.
inline void read_stores(const std::string& folder) {
  SessionStore sessions(folder + "/vat.db");
  CheckpointStore checkpoints(folder + "/checkpoints.db", std::size_t{1} << 20);
  SavedStateDatabase states(folder + "/states.db");
  for (const StoredSession& session : sessions.sessions()) {
    std::uint64_t last = 0;
    for (auto part = sessions.read(session.number, last); !part.empty();
         part = sessions.read(session.number, last)) {
      VAT_CHECK(part.back().sequence > last);
      last = part.back().sequence;
    }
    for (const CheckpointPlace& place : checkpoints.places(session.number)) {
      checkpoints.read(place);
    }
    checkpoints.hashes(session.number, 0);
    const std::string id = "s" + std::to_string(session.number);
    for (const SavedStateEntry& entry : states.list(id)) states.find(id, entry.name);
  }
}

}  // namespace vat::fuzz
