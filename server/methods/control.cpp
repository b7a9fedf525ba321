// scene.load, control.*

#include "server/methods/handlers.h"
#include "server/session/core/scene_loading.h"

namespace vat {
namespace {

ActionResult load_scene(SessionCore& core, const Json& value, Level level) {
  const SessionEnvironment& environment = core.environment();
  auto scene = read_client_scene(value, environment.catalogue, level);
  if (auto* error = std::get_if<RpcError>(&scene)) return std::move(*error);
  // The session keeps its instruction set, so that its log reproduces the same bits.
  auto simulation = make_on_device(std::get<Scene>(scene), environment,
                                   core.run().simulation().instruction_set());
  if (auto* error = std::get_if<RpcError>(&simulation)) return std::move(*error);
  if (const auto excess = core.run().admit(std::get<Simulation>(simulation))) {
    return limit_reached(*excess);
  }
  core.load(std::get<Simulation>(std::move(simulation)));
  return Json::object();
}

}  // namespace

SessionAction read_scene_load(ObjectReader& params, Errors&) {
  const Json* value = params.member("scene", true);
  const Level level = read_level(params);
  if (value == nullptr) return {};
  return [value = *value, level](SessionCore& core, Participant&) {
    return load_scene(core, value, level);
  };
}

SessionAction read_control_play(ObjectReader&, Errors&) {
  return [](SessionCore& core, Participant&) -> ActionResult {
    core.set_playing(true);
    return Json::object();
  };
}

SessionAction read_control_pause(ObjectReader&, Errors&) {
  return [](SessionCore& core, Participant&) -> ActionResult {
    core.set_playing(false);
    return Json::object();
  };
}

SessionAction read_control_step(ObjectReader& params, Errors&) {
  const std::uint64_t ticks = params.count("ticks", 1, kMaxTicksPerStep, 1);
  return [ticks](SessionCore& core, Participant&) -> ActionResult {
    // In a paused session, steps of other clients continue.
    if (core.clock().playing()) core.set_playing(false);
    return RunTicks{ticks};
  };
}

SessionAction read_control_reset(ObjectReader&, Errors&) {
  return [](SessionCore& core, Participant&) -> ActionResult {
    core.reset();
    return Json::object();
  };
}

SessionAction read_control_set_speed(ObjectReader& params, Errors&) {
  const double speed = params.real("speed", kMinSpeedFactor, kMaxSpeedFactor);
  return [speed](SessionCore& core, Participant&) -> ActionResult {
    core.set_speed(speed);
    return Json::object();
  };
}

}  // namespace vat
