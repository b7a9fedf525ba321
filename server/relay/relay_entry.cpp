#include "server/relay/relay_entry.h"

#include <utility>

namespace vat {

bool send_entry(RelayLine& line, const RelayPlace& place, const std::string& address,
                const RelayEntry& entry) {
  const Json open{{"subject", place.subject},
                  {"address", address},
                  {"is_open", entry.is_open},
                  {"access",
                   {{"role", static_cast<int>(entry.access.role)},
                    {"session", entry.access.session},
                    {"is_invitation", entry.access.is_invitation}}}};
  if (!line.send(RelayKind::open, open)) return false;
  return entry.token.empty() ||
         line.send(RelayKind::text, Json::object(), write_enter(entry.token));
}

std::string write_enter(const std::string& token) {
  return write_owner_request(kEnterId, "access.enter", {{"token", token}});
}

std::string write_owner_request(const char* id, std::string_view method, const Json& params) {
  return Json{{"jsonrpc", "2.0"}, {"id", id}, {"method", method}, {"params", params}}.dump();
}

RpcError read_owner_error(const Json& error) {
  Json data = error.at("data");
  const auto name = data.at("kind").get<std::string>();
  data.erase("kind");
  data.erase("hint");
  for (const ErrorRow& row : error_rows()) {
    if (row.name == name) return {row.kind, error.at("message"), std::move(data)};
  }
  return internal_error();
}

Role read_owner_role(const Json& name) {
  for (const Role role : {Role::viewer, Role::controller, Role::owner, Role::admin}) {
    if (name == to_string(role)) return role;
  }
  return Role::none;
}

Grant read_granted(const Json& result) {
  return {read_owner_role(result.at("role")), result.value("session", ""), true};
}

}  // namespace vat
