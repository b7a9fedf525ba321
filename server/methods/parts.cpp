#include "server/methods/parts.h"

#include <limits>

#include "core/limits.h"
#include "server/session/core/scene_loading.h"

namespace vat {

BodyId read_body_id(ObjectReader& params) {
  return static_cast<BodyId>(params.count("body", 0, std::numeric_limits<BodyId>::max()));
}

SessionId read_session_id(ObjectReader& params) {
  return params.text("session", kMaxNameLength);
}

SessionAction read_action_on(const char* parameter, ObjectReader& params,
                             ActionResult (*action)(SessionCore&, const Json&)) {
  const Json* value = params.member(parameter, true);
  if (value == nullptr) return {};
  return [value = *value, action](SessionCore& core, Participant&) { return action(core, value); };
}

std::optional<RpcError> change_within_limits(SessionCore& core,
                                             const std::function<Status(Simulation&)>& change) {
  Simulation& simulation = core.run().simulation();
  const Snapshot before = simulation.snapshot();
  const Status changed = change(simulation);
  if (!changed) return refused(changed.errors());
  std::optional<RpcError> error = find_excess(simulation, core.environment().limits);
  if (!error) {
    if (const auto excess = core.run().admit_change()) error = limit_reached(*excess);
  }
  if (error) simulation.restore(before);
  return error;
}

std::optional<RpcError> refuse_held_body(SessionCore& core, const Participant& participant,
                                         BodyId body) {
  const Participant* holder = core.participants().holder_of_body(body);
  if (holder == nullptr || holder->number == participant.number) return {};
  return held_by_other(holder->number, holder->name);
}

RpcResult list_sessions(const SessionDirectory& directory, const PendingReply& reply,
                        void (*add)(Json& session, const SessionSummary& summary)) {
  Json sessions = Json::array();
  for (const auto& [id, summary, state] : directory.list(reply)) {
    Json session{{"session", id},          {"name", summary.name},
                 {"state", state},         {"kind", summary.is_replay ? "replay" : "live"},
                 {"scene", summary.scene}, {"playing", summary.playing},
                 {"tick", summary.tick},   {"particles", summary.particles}};
    add(session, summary);
    sessions.push_back(std::move(session));
  }
  return Json{{"sessions", std::move(sessions)}};
}

}  // namespace vat
