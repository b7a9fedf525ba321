#include "server/session/core/session_command.h"

#include <utility>

#include "core/support/check.h"

namespace vat {

SessionCommand SessionMethods::make(std::string_view method, Json params) const {
  VAT_CHECK(parse != nullptr);
  auto command = parse(method, std::move(params));
  VAT_CHECK(std::holds_alternative<SessionCommand>(command));
  return std::get<SessionCommand>(std::move(command));
}

}  // namespace vat
