#include "server/messages/method_row.h"

namespace vat {

std::string MethodRow::schema_file() const {
  return std::string(name.substr(0, name.find('.'))) + ".json";
}

std::optional<RpcError> refuse_role(const MethodRow& row, Role role) {
  if (role >= row.least_role) return {};
  if (role == Role::none) return not_authenticated("the first message must be access.enter");
  return role_too_low(row.name, role, row.least_role);
}

}  // namespace vat
