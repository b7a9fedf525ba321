// frames.*

#include <array>
#include <limits>
#include <string_view>

#include "core/limits.h"
#include "server/methods/handlers.h"
#include "server/methods/parts.h"

namespace vat {
namespace {

constexpr std::array<std::string_view, kFrameAttributes> kAttributeNames = {
    "speed", "density", "pressure", "acceleration"};
// Finer errors than this are below the noise of the simulation.
constexpr double kMinAttributeError = 1e-6;  // [m/s], [kg/m^3], [Pa], [m/s^2]
constexpr double kMaxAttributeError = 1e12;

FrameRegion read_region(const Json& value, const std::string& path, Errors& errors) {
  ObjectReader reader(value, path, errors);
  FrameRegion region{reader.vector("min", -kMaxLength, kMaxLength),
                     reader.vector("max", -kMaxLength, kMaxLength)};
  reader.refuse_unknown();
  if ((region.max.array() < region.min.array()).any()) {
    add_error(errors, "out_of_range", path + "/max", "must not be below min, on any axis");
  }
  return region;
}

ByAttribute<double> read_attributes(const Json& value, const std::string& path, Errors& errors) {
  ObjectReader reader(value, path, errors);
  ByAttribute<double> attribute_errors{};
  for (std::size_t a = 0; a < kFrameAttributes; ++a) {
    if (!reader.has(kAttributeNames[a])) continue;
    attribute_errors[a] = reader.real(kAttributeNames[a], kMinAttributeError, kMaxAttributeError);
  }
  reader.refuse_unknown();
  return attribute_errors;
}

}  // namespace

Subscription read_subscription(ObjectReader& params, Errors& errors) {
  Subscription subscription;
  if (params.has("max_error")) subscription.max_error = params.real("max_error", 0, kMaxLength);
  subscription.every = params.count("every", 1, kMaxFrameInterval, 1);
  subscription.selection.detail =
      static_cast<std::uint8_t>(params.count("detail", 0, kFullDetail, kFullDetail));
  if (const Json* region = params.member("region")) {
    subscription.selection.region = read_region(*region, params.path_of("region"), errors);
  }
  if (const Json* attributes = params.member("attributes")) {
    subscription.attribute_errors =
        read_attributes(*attributes, params.path_of("attributes"), errors);
  }
  return subscription;
}

SessionAction read_frames_subscribe(ObjectReader& params, Errors& errors) {
  const Subscription subscription = read_subscription(params, errors);
  return [subscription](SessionCore& core, Participant& participant) -> ActionResult {
    core.notifier().subscribe(participant, subscription, core.environment().clock.now());
    return Json::object();
  };
}

SessionAction read_frames_unsubscribe(ObjectReader&, Errors&) {
  return [](SessionCore& core, Participant& participant) -> ActionResult {
    core.notifier().unsubscribe(participant);
    return Json::object();
  };
}

// Not a command of the session, so that the window opens at once.
ServerAction read_frames_ack(ObjectReader& params, Errors&) {
  const auto number = static_cast<std::uint32_t>(
      params.count("number", 1, std::numeric_limits<std::uint32_t>::max()));
  const bool is_rejected = params.boolean("rejected", false);
  return [number, is_rejected](SessionDirectory& directory,
                               PendingReply& reply) -> std::optional<RpcResult> {
    const auto now = directory.resources().clock.now();
    if (!reply.client()->acknowledge(number, now, is_rejected)) {
      return invalid_params({Error{"out_of_range", "/number", "must be of a frame that was sent"}});
    }
    Json answer = Json::object();
    if (!reply.wants_answer()) return answer;  // as nearly all of thousands a second
    if (const auto tick = directory.tick_of(reply)) answer["tick"] = *tick;
    return answer;
  };
}

}  // namespace vat
