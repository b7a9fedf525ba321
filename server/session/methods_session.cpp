// session.create, list, join, leave, close

#include "core/limits.h"
#include "server/session/method_parts.h"
#include "server/session/person_name.h"

namespace vat {
namespace {

template <class Error>
std::optional<RpcResult> to_answer(std::optional<Error> error) {
  if (!error) return {};
  return RpcResult(*std::move(error));
}

ServerAction read_create(ObjectReader& params, Errors&) {
  std::string name = params.text("name", kMaxNameLength);
  const Json* scene = params.member("scene", true);
  if (scene == nullptr) return {};
  return [name, scene = *scene](SessionDirectory& directory, PendingReply& caller) {
    return to_answer(directory.create_later(caller, name, scene));
  };
}

void add_clients(Json& session, const SessionSummary& summary) {
  session["clients"] = summary.clients;
}

ServerAction read_list_sessions(ObjectReader&, Errors&) {
  return [](SessionDirectory& directory, PendingReply& caller) {
    return list_sessions(directory, caller, add_clients);
  };
}

ServerAction read_join(ObjectReader& params, Errors& errors) {
  std::optional<SessionId> session;
  if (params.has("session")) session = read_session_id(params);
  JoinRequest join_request;
  if (params.has("name")) join_request.name = read_person_name(params, "name", errors);
  if (params.has("resume")) join_request.resume = params.text("resume", kMaxTokenBytes);
  return [session, join_request](SessionDirectory& directory, PendingReply& caller) {
    return to_answer(directory.join(caller, session, join_request));
  };
}

ServerAction read_leave(ObjectReader&, Errors&) {
  return [](SessionDirectory& directory, PendingReply& caller) {
    return to_answer(directory.leave(caller));
  };
}

ServerAction read_close(ObjectReader& params, Errors&) {
  const SessionId session = read_session_id(params);
  return [session](SessionDirectory& directory, PendingReply& caller) {
    return to_answer(directory.close(caller, session, "closed by a client"));
  };
}

constexpr Method kSessionMethods[] = {
    {"session.create", read_create}, {"session.list", read_list_sessions},
    {"session.join", read_join},     {"session.leave", read_leave},
    {"session.close", read_close},
};

}  // namespace

std::span<const Method> session_methods() {
  return kSessionMethods;
}

}  // namespace vat
