#include "server/access/role.h"

namespace vat {

const char* to_string(Role role) {
  switch (role) {
    case Role::none:
      return "none";
    case Role::viewer:
      return "viewer";
    case Role::controller:
      return "controller";
    case Role::owner:
      return "owner";
    case Role::admin:
      return "admin";
  }
  return "";
}

}  // namespace vat
