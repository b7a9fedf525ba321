// access.*: tokens that let clients in

#include "server/methods/handlers.h"
#include "server/methods/parts.h"

namespace vat {
ServerAction read_access_enter(ObjectReader& params, Errors&) {
  const std::string token = params.text("token", kMaxTokenBytes);
  return [token](SessionDirectory& directory, PendingReply& reply) {
    return directory.access().enter(reply, token);
  };
}

ServerAction read_access_ticket(ObjectReader& params, Errors&) {
  constexpr Role kRoles[] = {Role::viewer, Role::controller, Role::admin};
  const Role role = kRoles[params.choice("role", {"viewer", "controller", "admin"})];
  std::optional<SessionId> session;
  if (params.has("session")) session = read_session_id(params);
  return [role, session](SessionDirectory& directory,
                         PendingReply& reply) -> std::optional<RpcResult> {
    if (role == Role::admin && session) {
      const Error error{"out_of_range", "/role", "the role admin applies to all sessions"};
      return invalid_params({error});
    }
    if (auto error = directory.access().issue_ticket(reply, role, session)) return *error;
    return {};
  };
}

}  // namespace vat
