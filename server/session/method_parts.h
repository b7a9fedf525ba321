#pragma once

#include <functional>
#include <optional>

#include "server/session/method_table.h"

/// What several methods have in common.
namespace vat {

/// The parameter `body`, whether or not there is such a body.
BodyId read_body_id(ObjectReader& params);
/// The parameter `session`, whether or not there is such a session.
SessionId read_session_id(ObjectReader& params);

/// The action on a parameter that must be there, and that it reads itself once it is made: scenes
/// and their parts, whose errors name all that is wrong with them.
SessionAction read_action_on(const char* parameter, ObjectReader& params,
                             ActionResult (*action)(SessionCore&, const Json&));

/// Changes the simulation; if the core refuses that, or there is then more than the session, or all
/// of them, may have, it is as before, and the error is returned.
std::optional<RpcError> change_within_limits(SessionCore& core,
                                             const std::function<Status(Simulation&)>& change);

/// The error if somebody else holds the body.
std::optional<RpcError> refuse_held_body(SessionCore& core, const Participant& participant,
                                         BodyId body);

/// The answer with all sessions that are open to the caller; `add` says more of each.
RpcResult list_sessions(const SessionDirectory& directory, const PendingReply& caller,
                        void (*add)(Json& session, const SessionSummary& summary));

}  // namespace vat
