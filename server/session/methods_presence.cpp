// presence.*: who is in the session, and where they point

#include "core/limits.h"
#include "server/session/method_table.h"

namespace vat {
namespace {

SessionAction read_list_presence(ObjectReader&, Errors&) {
  return [](SessionCore& core, Participant&) -> ActionResult {
    return Json{{"participants", describe_participants(core.participants())}};
  };
}

SessionAction read_point(ObjectReader& params, Errors& errors) {
  std::optional<Pointer> pointer;
  if (params.has("position")) {
    pointer = Pointer{params.vector("position", -kMaxLength, kMaxLength), {}};
  }
  if (params.has("direction")) {
    const Vec3 direction = params.vector("direction", -1, 1);
    if (pointer) {
      pointer->direction = direction;
    } else {
      add_error(errors, "missing", params.path_of("position"), "a direction needs a position");
    }
  }
  return [pointer](SessionCore&, Participant& participant) -> ActionResult {
    participant.pointer = pointer;
    return Json::object();
  };
}

constexpr Method kPresenceMethods[] = {
    {"presence.list", read_list_presence},
    {"presence.point", read_point},
};

}  // namespace

std::span<const Method> presence_methods() {
  return kPresenceMethods;
}

}  // namespace vat
