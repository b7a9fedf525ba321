#pragma once

#include <functional>
#include <optional>

#include "server/directory/session_directory.h"

/// Functions that several handlers use.
namespace vat {

/// Reads the parameter `body`. The body may not exist.
BodyId read_body_id(ObjectReader& params);
/// Reads the parameter `session`. The session may not exist.
SessionId read_session_id(ObjectReader& params);

/// Returns an action on a required parameter, which the action itself reads: a scene or a part of
/// one, all of whose errors are reported.
SessionAction read_action_on(const char* parameter, ObjectReader& params,
                             ActionResult (*action)(SessionCore&, const Json&));

/// Changes the simulation. Undoes the change and returns the error if the core refuses it, or if a
/// limit of the session or of all sessions is exceeded.
std::optional<RpcError> change_within_limits(SessionCore& core,
                                             const std::function<Status(Simulation&)>& change);

/// Returns the error if another participant holds the body.
std::optional<RpcError> refuse_held_body(SessionCore& core, const Participant& participant,
                                         BodyId body);

/// Returns the sessions that the client may join. `add` adds members to each.
RpcResult list_sessions(const SessionDirectory& directory, const PendingReply& reply,
                        void (*add)(Json& session, const SessionSummary& summary));

}  // namespace vat
