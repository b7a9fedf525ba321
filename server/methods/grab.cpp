// grab.*: a grab belongs to the participant that started it

#include <algorithm>
#include <limits>
#include <optional>

#include "core/limits.h"
#include "server/methods/handlers.h"
#include "server/methods/parts.h"

namespace vat {
namespace {

constexpr std::uint64_t kMaxGrabId = 9'007'199'254'740'992;  // 2^53: what JSON numbers hold exactly

Vec3 read_target(ObjectReader& params) {
  return params.vector("target", -kMaxLength, kMaxLength);
}

std::uint64_t read_grab_id(ObjectReader& params) {
  return params.count("grab", 0, kMaxGrabId);
}

/// Returns the index of the particle with this number, or an invalid index.
Index index_of(const Simulation& simulation, BodyId id, Index number) {
  const std::optional<BodyView> body = simulation.find_body(id);
  if (!body || body->numbers.empty()) return number;
  const auto found = std::ranges::lower_bound(body->numbers, number);
  const bool is_there = found != body->numbers.end() && *found == number;
  if (!is_there) return static_cast<Index>(body->positions.size());
  return static_cast<Index>(found - body->numbers.begin());
}

ActionResult start(SessionCore& core, Participant& participant, const BodyKey& key, Index number,
                   const Vec3& target) {
  const std::size_t maximum = core.environment().limits.max_grabs_per_client;
  if (participant.grabs.size() >= maximum) return limit_reached("grabs_per_client", maximum);
  const std::optional<BodyView> found = find_body(core.run().simulation(), key);
  if (!found) return no_body_with_key(core.run().simulation(), key, "/body");
  const BodyId body = found->id;
  if (auto error = refuse_held_body(core, participant, body)) return *std::move(error);
  const std::uint64_t grab = core.run().last_grab() + 1;
  Simulation& simulation = core.run().simulation();
  const Index particle = index_of(simulation, body, number);
  const Status started = simulation.grab_start(grab, body, particle, target);
  if (!started) {
    if (started.errors().front().code != "limit_reached") return refused(started.errors());
    return limit_reached("grabs_per_session", kMaxGrabs);
  }
  core.run().set_last_grab(grab);
  participant.grabs.emplace(grab, body);
  participant.grab_uses[grab] = core.environment().clock.now();
  return Json{{"grab", grab}};
}

/// Returns the error if the grab is not the participant's.
std::optional<RpcError> refuse_grab(SessionCore& core, const Participant& participant,
                                    std::uint64_t grab) {
  if (participant.grabs.contains(grab)) return {};
  if (core.participants().holder_of(grab) != nullptr) {
    return not_allowed("the grab belongs to another participant");
  }
  return invalid_params({Error{"no_such_grab", "/grab", "must be a grab of this participant"}});
}

}  // namespace

SessionAction read_grab_start(ObjectReader& params, Errors& errors) {
  const Json* body = params.member("body", true);
  std::optional<BodyKey> key;
  if (body != nullptr) key = to_body_key(*body, params.path_of("body"), errors);
  const auto particle =
      static_cast<Index>(params.count("particle", 0, std::numeric_limits<Index>::max()));
  const Vec3 target = read_target(params);
  if (!key) return {};
  return [key = *std::move(key), particle, target](SessionCore& core, Participant& participant) {
    return start(core, participant, key, particle, target);
  };
}

SessionAction read_grab_move(ObjectReader& params, Errors&) {
  const std::uint64_t grab = read_grab_id(params);
  const Vec3 target = read_target(params);
  return [grab, target](SessionCore& core, Participant& participant) -> ActionResult {
    if (auto error = refuse_grab(core, participant, grab)) return *std::move(error);
    const Status moved = core.run().simulation().grab_move(grab, target);
    if (!moved) return refused(moved.errors());
    participant.grab_uses[grab] = core.environment().clock.now();
    return Json::object();
  };
}

SessionAction read_grab_end(ObjectReader& params, Errors&) {
  const std::uint64_t grab = read_grab_id(params);
  return [grab](SessionCore& core, Participant& participant) -> ActionResult {
    if (auto error = refuse_grab(core, participant, grab)) return *std::move(error);
    const Status ended = core.run().simulation().grab_end(grab);
    if (!ended) return refused(ended.errors());
    core.participants().forget_grab(grab);
    return Json::object();
  };
}

}  // namespace vat
