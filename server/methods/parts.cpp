#include "server/methods/parts.h"

#include <limits>
#include <utility>

#include "core/limits.h"
#include "core/support/nearest_name.h"
#include "server/session/core/scene_loading.h"

namespace vat {

BodyId read_body_id(ObjectReader& params, Errors& errors) {
  const Json* value = params.member("body", true);
  if (value == nullptr) return 0;
  if (value->is_string()) {
    add_error(errors, "wrong_type", params.path_of("body"), "must be the id of a body, not a name");
    return 0;
  }
  constexpr BodyId kMax = std::numeric_limits<BodyId>::max();
  return static_cast<BodyId>(to_count(*value, params.path_of("body"), 0, kMax, errors).value_or(0));
}

std::optional<BodyKey> to_body_key(const Json& value, const std::string& path, Errors& errors) {
  if (value.is_string()) {
    if (auto name = to_text(value, path, kMaxNameLength, errors)) return *std::move(name);
    return {};
  }
  if (!value.is_number()) {
    add_error(errors, "wrong_type", path, "must be the id or the name of a body");
    return {};
  }
  const auto id = to_count(value, path, 0, std::numeric_limits<BodyId>::max(), errors);
  if (!id) return {};
  return static_cast<BodyId>(*id);
}

std::optional<BodyView> find_body(const Simulation& simulation, const BodyKey& key) {
  if (const auto* id = std::get_if<BodyId>(&key)) return simulation.find_body(*id);
  const auto id = simulation.find_body(std::get<std::string>(key));
  return id ? simulation.find_body(*id) : std::nullopt;
}

RpcError no_body_with_key(const Simulation& simulation, const BodyKey& key,
                          const std::string& path) {
  RpcError error = no_such_body("no body has this id or name", path);
  const auto* name = std::get_if<std::string>(&key);
  if (name == nullptr) return error;
  NearestName nearest(*name);
  nearest.consider_all(simulation.bodies(), &BodyView::name);
  return with_suggestion(std::move(error), nearest.suggestion());
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
  for (const ListedSession& listed : directory.list(reply)) {
    Json session = describe_session(listed);
    add(session, listed.summary);
    sessions.push_back(std::move(session));
  }
  return Json{{"sessions", std::move(sessions)}};
}

}  // namespace vat
