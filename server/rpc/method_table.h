#pragma once

#include <span>
#include <string_view>
#include <variant>

#include "server/messages/method_row.h"
#include "server/methods/handlers.h"

namespace vat {

/// Method of the protocol: properties, and handler of the calls.
struct Method {
  template <class Handler>
  constexpr Method(std::string_view name, Role least_role, RoleSource role_source,
                   RateClass rate_class, Logging logging, Handler handler_in)
      : row{name, least_role, role_source, rate_class, logging}, handler(handler_in) {}

  MethodRow row;
  std::variant<ServerHandler, SessionHandler> handler;
};

/// Returns all methods, in the order of PROTOCOL.md. The table is the only list of methods for
/// dispatch, roles, rate limits and logging. Tests compare the documents and the client's types
/// with the table.
std::span<const Method> all_methods();
/// Returns the method, or null if no method has this name.
const Method* find_method(std::string_view name);
/// Returns the method table as sessions use it.
const SessionMethods& session_methods();

}  // namespace vat
