#pragma once

#include <string>
#include <string_view>

#include "server/session/core/session_core.h"
#include "server/storage/saved/saved_states.h"

namespace vat {

/// Method name of the log entry that restores a saved state. The entry contains the state, so that
/// the log does not depend on the saved state.
inline constexpr std::string_view kRestoreEntry = "restore";

/// Snapshot of a session for saving. The snapshot is independent of the session, so that any thread
/// can use it.
struct MomentToSave {
  Snapshot present;
  Snapshot as_loaded;
  std::uint64_t tick = 0;
  std::vector<std::uint64_t> grabs;  ///< ids of all active grabs
};

/// Returns a snapshot of the session's current state.
MomentToSave moment_to_save(SessionCore& core);
/// Returns the serialised and compressed state. The function is slow.
SavedState make_saved_state(const MomentToSave& moment, const std::string& name,
                            const std::string& saved_by, double wall_time);

/// Returns the parameters of a log entry with the method kRestoreEntry.
Json params_of_restore(const SavedState& state);
/// Returns the action of a log entry with the method kRestoreEntry. The action restores the saved
/// state without grabs, and does not change playing state and speed. The action returns
/// limit_reached if the state exceeds the server's current limits. The function and the action
/// throw StorageError (kind `corrupt`) for invalid parameters.
SessionAction read_restore(const Json& params);

}  // namespace vat
