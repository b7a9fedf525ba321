#pragma once

#include "server/session/core/session_core.h"

/// Operations that set the state of a session during a recovery or a replay.
namespace vat {

/// Continues the session from an earlier moment. `as_loaded` is the state that a reset restores.
void resume(SessionCore& core, const SessionMoment& moment, Simulation simulation,
            Snapshot as_loaded);

/// Sets the stored progress that the log does not contain: clock and participants. Throws
/// StorageError (kind `corrupt`) if the participants are invalid.
void apply_progress(SessionCore& core, const SessionProgress& progress);

/// Pauses a session whose recovered state differs from the stored state.
void diverge(SessionCore& core, Divergence divergence);

/// Ends a recovery: starts a new epoch and marks all participants as away. A diverged session gets
/// no participants. The log of a diverged session is not changed before a reset or a load.
void end_recovery(SessionCore& core, SteadyClock::time_point now);

}  // namespace vat
