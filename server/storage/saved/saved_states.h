#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

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
  std::size_t bytes = 0;       ///< size in the store
};

struct SavedState {
  SavedStateEntry entry;
  std::string fields;               ///< JSON object: the scene, and state except the simulation
  std::vector<std::uint8_t> state;  ///< compressed state of the simulation

  std::size_t size() const { return fields.size() + state.size(); }  ///< [bytes]
};

/// Greatest numbers and sizes [bytes] of saved states.
struct SavedStateLimits {
  std::size_t per_session = 0;
  std::size_t bytes_per_session = 0;
  std::size_t bytes_in_all = 0;
};

/// Numbers and sizes [bytes] of saved states.
struct SavedStateUse {
  std::size_t in_session = 0;
  std::size_t bytes_in_session = 0;
  std::size_t bytes_in_all = 0;
};

/// Returns the limit that the store would exceed with a further state of this size, if any.
std::optional<LimitExcess> find_excess(const SavedStateUse& use, std::size_t bytes,
                                       const SavedStateLimits& limits);

/// Store of the saved states of sessions. Thread-safe. Functions wait, and throw StorageError.
class SavedStates {
 public:
  SavedStates() = default;
  virtual ~SavedStates() = default;
  SavedStates(const SavedStates&) = delete;
  SavedStates& operator=(const SavedStates&) = delete;

  /// Writes or replaces the state with this name. Returns the limit that would be exceeded, if any.
  virtual std::optional<LimitExcess> write(const std::string& session, const SavedState& state,
                                           const SavedStateLimits& limits) = 0;
  /// Returns the entries in alphabetical order of names.
  virtual std::vector<SavedStateEntry> list(const std::string& session) = 0;
  virtual std::optional<SavedState> find(const std::string& session, const std::string& name) = 0;
  /// Removes a state. Returns false if there is no such state.
  virtual bool remove(const std::string& session, const std::string& name) = 0;
};

}  // namespace vat
