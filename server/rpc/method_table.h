#pragma once

#include <span>
#include <string_view>
#include <variant>

#include "server/messages/method_row.h"
#include "server/methods/handlers.h"

namespace vat {

/// A method of the protocol: its properties, and the handler of its calls.
struct Method {
  template <class Handler>
  constexpr Method(std::string_view name, Role least_role, RoleSource role_source,
                   RateClass rate_class, Logging logging, Handler handler_in)
      : row{name, least_role, role_source, rate_class, logging}, handler(handler_in) {}

  MethodRow row;
  std::variant<ServerHandler, SessionHandler> handler;
};

/// All methods, in the order of PROTOCOL.md. The only list of methods: dispatch, roles, rate
/// limits and the log use it, and tests compare the documents and the client's types with it.
std::span<const Method> all_methods();
/// Returns null if no method has this name.
const Method* find_method(std::string_view name);
/// The methods as sessions use them.
const SessionMethods& session_methods();

}  // namespace vat
