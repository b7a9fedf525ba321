// presence.*: participants of the session, and their pointers

#include "core/limits.h"
#include "server/methods/handlers.h"

namespace vat {
SessionAction read_presence_list(ObjectReader&, Errors&) {
  return [](SessionCore& core, Participant&) -> ActionResult {
    return Json{{"participants", describe_participants(core.participants())}};
  };
}

SessionAction read_presence_point(ObjectReader& params, Errors& errors) {
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

}  // namespace vat
