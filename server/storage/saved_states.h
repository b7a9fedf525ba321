#pragma once

#include <cstddef>
#include <cstdint>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "server/storage/database.h"
#include "server/storage/saved_excess.h"

namespace vat {

/// A state of a session that somebody has saved, as it is listed.
struct SavedStateEntry {
  std::string name;
  std::string saved_by;        ///< the name of a person
  double time = 0;             ///< [s] since 1970
  std::uint64_t tick = 0;      ///< as in a LogEntry
  double simulation_time = 0;  ///< [s]
  std::uint64_t hash = 0;      ///< of the simulation's state
  std::size_t bytes = 0;       ///< that it takes here
};

struct SavedState {
  SavedStateEntry entry;
  std::string fields;               ///< JSON, an object: the scene, and what is beside the state
  std::vector<std::uint8_t> state;  ///< of the simulation, compressed
};

/// How many states of a session are kept, and how large they are.
struct SavedStateLimits {
  std::size_t per_session = 0;
  std::size_t bytes_per_session = 0;
  std::size_t bytes_in_all = 0;
};

/// The sessions' saved states, in a database of their own, so that one that is large holds up no
/// command of others. Safe to use from any thread; throws StorageError.
class SavedStates {
 public:
  /// `path` may be MainDatabase::kInMemory.
  explicit SavedStates(const std::string& path);

  /// Keeps it, in place of one of its name if there is one; or tells what stands in the way.
  std::optional<SavedExcess> write(const std::string& session, const SavedState& state,
                                   const SavedStateLimits& limits);
  /// In the order of their names.
  std::vector<SavedStateEntry> list(const std::string& session);
  std::optional<SavedState> find(const std::string& session, const std::string& name);
  /// False where there is none.
  bool remove(const std::string& session, const std::string& name);
  void remove_session(const std::string& session);
  /// Removes those of all other sessions.
  void keep_only(const std::vector<std::string>& sessions);

  std::size_t move_log(bool wait);

 private:
  std::optional<SavedExcess> find_excess(const std::string& session, const SavedState& state,
                                         const SavedStateLimits& limits);

  std::mutex mutex_;
  Database database_;
};

}  // namespace vat
