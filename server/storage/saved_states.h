#pragma once

#include <cstddef>
#include <cstdint>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "server/storage/sqlite/database.h"
#include "server/storage/sqlite/schema.h"
#include "server/support/limit_excess.h"

namespace vat {

/// List entry of a saved state.
struct SavedStateEntry {
  std::string name;
  std::string saved_by;        ///< name of a participant
  double time = 0;             ///< [s since 1970]
  std::uint64_t tick = 0;      ///< see LogEntry
  double simulation_time = 0;  ///< [s]
  std::uint64_t hash = 0;      ///< hash of the simulation's state
  std::size_t bytes = 0;       ///< size in the database
};

struct SavedState {
  SavedStateEntry entry;
  std::string fields;               ///< JSON object: the scene, and state except the simulation
  std::vector<std::uint8_t> state;  ///< compressed state of the simulation
};

/// Greatest numbers and sizes [bytes] of saved states.
struct SavedStateLimits {
  std::size_t per_session = 0;
  std::size_t bytes_per_session = 0;
  std::size_t bytes_in_all = 0;
};

/// Store of the saved states of sessions. Uses a separate database, so that large states do not
/// delay commands. Thread-safe. Functions throw StorageError.
class SavedStates {
 public:
  /// `path` may be MainDatabase::kInMemory.
  explicit SavedStates(const std::string& path, Durability durability = Durability::process);

  /// Writes or replaces the state with this name. Returns the limit that would be exceeded, if any.
  std::optional<LimitExcess> write(const std::string& session, const SavedState& state,
                                   const SavedStateLimits& limits);
  /// Returns the entries in alphabetical order of names.
  std::vector<SavedStateEntry> list(const std::string& session);
  std::optional<SavedState> find(const std::string& session, const std::string& name);
  /// Removes a state. Returns false if there is no such state.
  bool remove(const std::string& session, const std::string& name);
  /// Removes the states of a session, and frees their space on the disk.
  void remove_session(const std::string& session);
  /// Removes the states of all other sessions.
  void keep_only(const std::vector<std::string>& sessions);

  std::size_t move_log(bool wait);

 private:
  std::optional<LimitExcess> find_excess(const std::string& session, const SavedState& state,
                                         const SavedStateLimits& limits);

  std::mutex mutex_;
  Database database_;
};

/// Returns the schema of the store's database.
Schema state_schema();

}  // namespace vat
