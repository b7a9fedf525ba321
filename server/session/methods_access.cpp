// access.*: tokens that let clients in

#include "server/session/method_parts.h"

namespace vat {
namespace {

ServerAction read_enter(ObjectReader& params, Errors&) {
  const std::string token = params.text("token", kMaxTokenBytes);
  return [token](SessionDirectory& directory, PendingReply& caller) {
    return directory.enter(caller, token);
  };
}

ServerAction read_ticket(ObjectReader& params, Errors&) {
  constexpr Role kRoles[] = {Role::viewer, Role::controller, Role::admin};
  const Role role = kRoles[params.choice("role", {"viewer", "controller", "admin"})];
  std::optional<SessionId> session;
  if (params.has("session")) session = read_session_id(params);
  return [role, session](SessionDirectory& directory,
                         PendingReply& caller) -> std::optional<RpcResult> {
    if (role == Role::admin && session) {
      const Error error{"out_of_range", "/role", "an admin is one in all sessions"};
      return invalid_params({error});
    }
    return directory.issue_ticket(caller, role, session);
  };
}

constexpr Method kAccessMethods[] = {
    {"access.enter", read_enter},
    {"access.ticket", read_ticket},
};

}  // namespace

std::span<const Method> access_methods() {
  return kAccessMethods;
}

}  // namespace vat
