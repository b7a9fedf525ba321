#pragma once

#include <string>
#include <string_view>

#include "server/session/core/session_core.h"
#include "server/storage/saved_states.h"

namespace vat {

/// Method name of the entry that restores a saved state. The entry contains the state, so that the
/// log does not depend on the saved one.
inline constexpr std::string_view kRestoreEntry = "restore";

/// State of a session to be saved. Any thread may use it.
struct MomentToSave {
  Snapshot present;
  Snapshot as_loaded;
  std::uint64_t tick = 0;
  std::vector<std::uint64_t> grabs;  ///< ids of all grabs
};

/// Returns the session's current state.
MomentToSave moment_to_save(SessionCore& core);
/// Serialises and compresses the state, which takes long.
SavedState make_saved_state(const MomentToSave& moment, const std::string& name,
                            const std::string& saved_by, double wall_time);

/// Returns the parameters of a kRestoreEntry.
Json params_of_restore(const SavedState& state);
/// Returns the action of a kRestoreEntry: restores the saved state, except the clock, without
/// grabs. The action returns limit_reached if the state exceeds the server's current limits. Both
/// throw StorageError, of kind corrupt, for invalid parameters.
SessionAction read_restore(const Json& params);

}  // namespace vat
