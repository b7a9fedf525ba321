// world.move_body, set_material, set_numerics, move_vat: ranges are those of the core

#include <array>

#include "protocol/scene/numerics_change.h"
#include "protocol/scene/scene_json.h"
#include "server/methods/handlers.h"
#include "server/methods/parts.h"

namespace vat {
namespace {

std::optional<Quat> read_orientation(ObjectReader& params, Errors& errors) {
  constexpr std::size_t kNumbers = 4;
  const Json* list = params.array("orientation", kNumbers);
  if (list == nullptr) return {};
  const std::string path = params.path_of("orientation");
  std::array<Real, kNumbers> numbers{};
  if (to_array(*list, path, kNumbers, kNumbers, errors) == nullptr) return {};
  for (std::size_t i = 0; i < kNumbers; ++i) {
    numbers[i] = to_real((*list)[i], pointer_to(path, i), -2, 2, errors).value_or(0);
  }
  return Quat(numbers[0], numbers[1], numbers[2], numbers[3]);
}

ActionResult set_material(SessionCore& core, const Json& value) {
  const Result<Material> material = read_material(value, "/material");
  if (!material) return refused(material.errors());
  // It may join more of a body's particles.
  auto error = change_within_limits(
      core, [&](Simulation& simulation) { return simulation.set_material(material.value()); });
  if (error) return *std::move(error);
  core.notifier().mark_description();
  return Json::object();
}

}  // namespace

SessionAction read_world_move_body(ObjectReader& params, Errors& errors) {
  const BodyId body = read_body_id(params, errors);
  BodyPlacement place;
  place.center_of_mass = params.vector("position", kAnyMin, kAnyMax);
  place.orientation = read_orientation(params, errors);
  if (params.has("velocity")) place.velocity = params.vector("velocity", kAnyMin, kAnyMax);
  return [body, place](SessionCore& core, Participant& participant) -> ActionResult {
    if (auto error = refuse_held_body(core, participant, body)) return *std::move(error);
    const Status moved = core.run().simulation().move_body(body, place);
    if (!moved) return refused(moved.errors());
    core.start_epoch(true);
    return Json::object();
  };
}

SessionAction read_world_set_material(ObjectReader& params, Errors&) {
  return read_action_on("material", params, set_material);
}

SessionAction read_world_set_numerics(ObjectReader& params, Errors& errors) {
  const NumericsChange change = read_numerics_change(params);
  if (change == NumericsChange{} && errors.empty()) {
    add_error(errors, "missing", params.path_of("integrator"),
              "must be given, unless another member is given");
  }
  return [change](SessionCore& core, Participant&) -> ActionResult {
    // Shorter steps need more of the limit particle_steps_per_tick.
    auto error = change_within_limits(
        core, [&](Simulation& simulation) { return simulation.set_numerics(change); });
    if (error) return *std::move(error);
    return Json::object();
  };
}

SessionAction read_world_move_vat(ObjectReader& params, Errors&) {
  const Vec3 offset = params.vector("offset", kAnyMin, kAnyMax);
  return [offset](SessionCore& core, Participant&) -> ActionResult {
    const Status moved = core.run().simulation().move_vat(offset);
    if (!moved) return refused(moved.errors());
    return Json::object();
  };
}

}  // namespace vat
