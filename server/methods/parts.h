#pragma once

#include <functional>
#include <optional>
#include <string>
#include <variant>

#include "server/directory/session_directory.h"

/// Functions that several method handlers use.
namespace vat {

/// Reads the parameters of frames.subscribe.
Subscription read_subscription(ObjectReader& params, Errors& errors);

/// Returns the parameter `body`, which must be an id. The body may not exist.
BodyId read_body_id(ObjectReader& params, Errors& errors);

/// A body by id or by name.
using BodyKey = std::variant<BodyId, std::string>;
/// Returns the key in `value`. If the value is neither an id nor a name, adds an error.
std::optional<BodyKey> to_body_key(const Json& value, const std::string& path, Errors& errors);
/// Returns the body, or an empty optional if there is no such body.
std::optional<BodyView> find_body(const Simulation& simulation, const BodyKey& key);
/// Returns the error for a key without a body, with a suggestion from the names of the bodies.
RpcError no_body_with_key(const Simulation& simulation, const BodyKey& key,
                          const std::string& path);

/// Returns the parameter `session`. The session may not exist.
SessionId read_session_id(ObjectReader& params);

/// Returns an action that reads the required parameter `parameter` (a scene or a part of a scene).
/// The action reports all errors of the parameter.
SessionAction read_action_on(const char* parameter, ObjectReader& params,
                             ActionResult (*action)(SessionCore&, const Json&));

/// Changes the simulation. If the core rejects the change or the change exceeds a limit, undoes the
/// change and returns an error.
std::optional<RpcError> change_within_limits(SessionCore& core,
                                             const std::function<Status(Simulation&)>& change);

/// Returns an error if another participant has grabbed the body.
std::optional<RpcError> refuse_held_body(SessionCore& core, const Participant& participant,
                                         BodyId body);

/// Returns the sessions that the client may join. `add` adds members to each session.
RpcResult list_sessions(const SessionDirectory& directory, const PendingReply& reply,
                        void (*add)(Json& session, const SessionSummary& summary));

}  // namespace vat
