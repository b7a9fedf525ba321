#pragma once

#include "server/session/core/session_core.h"

/// Operations by which a recovery or replay sets the state of a session.
namespace vat {

/// Continues from an earlier moment of the session. `as_loaded` is the state of a reset.
void resume(SessionCore& core, const SessionMoment& moment, Simulation simulation,
            Snapshot as_loaded);

/// Sets the parts of the stored progress that the log does not contain: clock and participants.
/// Throws StorageError, of kind corrupt.
void apply_progress(SessionCore& core, const SessionProgress& progress);

/// Pauses a session that was recovered in another state than the stored one.
void diverge(SessionCore& core, Divergence divergence);

/// After a recovery: the session continues in a new epoch, with all participants away. A diverged
/// session has no participants, and its log stays unchanged until somebody continues it.
void end_recovery(SessionCore& core, SteadyClock::time_point now);

}  // namespace vat
