// scene.load, control.*

#include "server/session/method_parts.h"
#include "server/session/scene_loading.h"

namespace vat {
namespace {

ActionResult load_scene(SessionCore& core, const Json& value) {
  const SessionEnvironment& environment = core.environment();
  auto scene = read_client_scene(value, environment.catalogue);
  if (auto* error = std::get_if<RpcError>(&scene)) return std::move(*error);
  // A session keeps to its instructions, so that its log leads to the same bits.
  auto simulation = make_simulation(std::get<Scene>(scene), environment,
                                    core.run().simulation().instruction_set());
  if (auto* error = std::get_if<RpcError>(&simulation)) return std::move(*error);
  if (const auto excess = core.run().admit(std::get<Simulation>(simulation))) {
    return limit_reached(*excess);
  }
  core.load(std::get<Simulation>(std::move(simulation)));
  return Json::object();
}

SessionAction read_load_scene(ObjectReader& params, Errors&) {
  return read_action_on("scene", params, load_scene);
}

SessionAction read_play(ObjectReader&, Errors&) {
  return [](SessionCore& core, Participant&) -> ActionResult {
    core.set_playing(true);
    return Json::object();
  };
}

SessionAction read_pause(ObjectReader&, Errors&) {
  return [](SessionCore& core, Participant&) -> ActionResult {
    core.set_playing(false);
    return Json::object();
  };
}

SessionAction read_step(ObjectReader& params, Errors&) {
  const std::uint64_t ticks = params.count("ticks", 1, kMaxTicksPerStep, 1);
  return [ticks](SessionCore& core, Participant&) -> ActionResult {
    // Where it stands already, steps of other clients go on.
    if (core.playing()) core.set_playing(false);
    return RunTicks{ticks};
  };
}

SessionAction read_reset(ObjectReader&, Errors&) {
  return [](SessionCore& core, Participant&) -> ActionResult {
    core.reset();
    return Json::object();
  };
}

SessionAction read_set_speed(ObjectReader& params, Errors&) {
  const double speed = params.real("speed", kMinSpeedFactor, kMaxSpeedFactor);
  return [speed](SessionCore& core, Participant&) -> ActionResult {
    core.set_speed(speed);
    return Json::object();
  };
}

constexpr Method kControlMethods[] = {
    {"scene.load", read_load_scene}, {"control.play", read_play},
    {"control.pause", read_pause},   {"control.step", read_step},
    {"control.reset", read_reset},   {"control.set_speed", read_set_speed},
};

}  // namespace

std::span<const Method> control_methods() {
  return kControlMethods;
}

}  // namespace vat
