#pragma once

#include <cstddef>
#include <string>
#include <string_view>

#include "server/session/session_core.h"
#include "server/storage/saved_states.h"

namespace vat {

/// The entry by which a session goes to a state that was saved: it holds all of it, so that a log
/// leads there whatever becomes of what was saved.
inline constexpr std::string_view kRestoreEntry = "restore";

/// A moment of a session as it is saved: nothing in it changes any more, and any thread may work on
/// it.
struct MomentToSave {
  Snapshot present;
  Snapshot as_loaded;
  std::uint64_t tick = 0;
  std::vector<std::uint64_t> grabs;  ///< that hold something
};

/// The session's present moment.
MomentToSave moment_to_save(SessionCore& core);
/// What is kept of it; takes its time.
SavedState make_saved_state(const MomentToSave& moment, const std::string& name,
                            const std::string& saved_by, double wall_time);

/// The params of a kRestoreEntry.
Json params_of_restore(const SavedState& state);
/// What the entry does: the session is as it was when it was saved, but for its clock, and nothing
/// is held. The action gives limit_reached where that is too large for this server now. Throws
/// StorageError, of kind corrupt, for params that params_of_restore() does not give; so does the
/// action.
SessionAction read_restore(const Json& params);

}  // namespace vat
