#pragma once

#include "server/session/core/session_core.h"

/// Operations by which a recovery or replay sets the state of a session.
namespace vat {

/// Continues from an earlier moment of the session. `as_loaded` is the state that a reset restores.
void resume(SessionCore& core, const SessionMoment& moment, Simulation simulation,
            Snapshot as_loaded);

/// Sets the parts of the stored progress that the log does not contain: clock and participants.
/// Throws StorageError, of kind corrupt.
void apply_progress(SessionCore& core, const SessionProgress& progress);

/// Pauses a session whose recovered state differs from the stored state.
void diverge(SessionCore& core, Divergence divergence);

/// After a recovery: the session continues in a new epoch, with all participants away. A diverged
/// session has no participants. Its log is not changed before a reset or a load.
void end_recovery(SessionCore& core, SteadyClock::time_point now);

}  // namespace vat
