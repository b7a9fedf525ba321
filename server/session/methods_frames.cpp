// frames.*

#include <limits>

#include "core/limits.h"
#include "server/session/method_table.h"

namespace vat {
namespace {

SessionAction read_subscribe(ObjectReader& params, Errors&) {
  Subscription subscription;
  subscription.max_error = params.real("max_error", 0, kMaxLength, 0.0);
  subscription.every = params.count("every", 1, kMaxFrameInterval, 1);
  return [subscription](SessionCore& core, Member& member) -> ActionResult {
    core.subscribe(member, subscription);
    return Json::object();
  };
}

SessionAction read_unsubscribe(ObjectReader&, Errors&) {
  return [](SessionCore& core, Member& member) -> ActionResult {
    core.unsubscribe(member);
    return Json::object();
  };
}

// Not a command of the session: the window opens at once, not at its next turn.
ServerAction read_ack(ObjectReader& params, Errors&) {
  const auto number = static_cast<std::uint32_t>(
      params.count("number", 1, std::numeric_limits<std::uint32_t>::max()));
  return [number](SessionDirectory& directory, Caller& caller) -> std::optional<RpcResult> {
    if (!caller.client()->acknowledge(number)) {
      return invalid_params({Error{"out_of_range", "/number", "must be of a frame that was sent"}});
    }
    Json reply = Json::object();
    if (const auto tick = directory.tick_of(caller)) reply["tick"] = *tick;
    return reply;
  };
}

constexpr Method kMethods[] = {
    {"frames.subscribe", read_subscribe},
    {"frames.unsubscribe", read_unsubscribe},
    {"frames.ack", read_ack},
};

}  // namespace

std::span<const Method> frame_methods() {
  return kMethods;
}

}  // namespace vat
