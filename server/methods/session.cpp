// session.create, list, join, leave, close

#include "core/limits.h"
#include "server/methods/handlers.h"
#include "server/methods/parts.h"
#include "server/people/person_name.h"
#include "server/session/core/scene_loading.h"

namespace vat {
namespace {

template <class Error>
std::optional<RpcResult> to_answer(std::optional<Error> error) {
  if (!error) return {};
  return RpcResult(*std::move(error));
}

void add_clients(Json& session, const SessionSummary& summary) {
  session["clients"] = summary.clients;
}

}  // namespace

ServerAction read_session_create(ObjectReader& params, Errors&) {
  std::string name = params.text("name", kMaxNameLength);
  const Json* scene = params.member("scene", true);
  const Level level = read_level(params);
  if (scene == nullptr) return {};
  return [name, scene = *scene, level](SessionDirectory& directory, PendingReply& reply) {
    return to_answer(directory.create_later(reply, name, scene, level));
  };
}

ServerAction read_session_list(ObjectReader&, Errors&) {
  return [](SessionDirectory& directory, PendingReply& reply) {
    return list_sessions(directory, reply, add_clients);
  };
}

ServerAction read_session_join(ObjectReader& params, Errors& errors) {
  std::optional<SessionId> session;
  if (params.has("session")) session = read_session_id(params);
  JoinRequest join_request;
  if (params.has("name")) join_request.name = read_person_name(params, "name", errors);
  if (params.has("resume")) join_request.resume = params.text("resume", kMaxTokenBytes);
  if (params.has("role")) {
    constexpr Role kRoles[] = {Role::viewer, Role::controller};
    join_request.greatest_role = kRoles[params.choice("role", {"viewer", "controller"})];
  }
  return [session, join_request](SessionDirectory& directory, PendingReply& reply) {
    return to_answer(directory.join(reply, session, join_request));
  };
}

ServerAction read_session_leave(ObjectReader&, Errors&) {
  return [](SessionDirectory& directory, PendingReply& reply) {
    return to_answer(directory.leave(reply));
  };
}

ServerAction read_session_close(ObjectReader& params, Errors&) {
  const SessionId session = read_session_id(params);
  return [session](SessionDirectory& directory, PendingReply& reply) {
    return to_answer(directory.close(reply, session, "closed by a client"));
  };
}

}  // namespace vat
