// world.*: ranges are those of the core, which names them in its errors

#include <limits>

#include "core/limits.h"
#include "protocol/scene_json.h"
#include "server/session/method_table.h"
#include "server/session/scene_loading.h"

namespace vat {
namespace {

BodyId read_body_id(ObjectReader& params) {
  return static_cast<BodyId>(params.count("body", 0, std::numeric_limits<BodyId>::max()));
}

ActionResult add_body(SessionCore& core, const Json& value) {
  const Result<BodyDescription> body = read_body(value, "/body", refuse_mesh_file);
  if (!body) return refused(body.errors());
  Simulation& simulation = core.run().simulation();
  const Snapshot before = simulation.snapshot();
  const Result<BodyId> id = simulation.add_body(body.value());
  if (!id) return refused(id.errors());
  if (auto excess = find_excess(simulation, core.environment().limits)) {
    simulation.restore(before);
    return *std::move(excess);
  }
  if (const auto excess = core.run().admit_change()) {
    simulation.restore(before);
    return limit_reached(*excess);
  }
  core.bodies_changed();
  return Json{{"body", id.value()}};
}

SessionAction read_add_body(ObjectReader& params, Errors&) {
  const Json* body = params.member("body", true);
  if (body == nullptr) return {};
  return [body = *body](SessionCore& core, Participant&) { return add_body(core, body); };
}

SessionAction read_remove_body(ObjectReader& params, Errors&) {
  const BodyId body = read_body_id(params);
  return [body](SessionCore& core, Participant&) -> ActionResult {
    const Status removed = core.run().simulation().remove_body(body);
    if (!removed) return refused(removed.errors());
    core.run().admit_change();  // less
    core.participants().forget_grabs_of(body);
    core.bodies_changed();
    return Json::object();
  };
}

SessionAction read_melt_body(ObjectReader& params, Errors&) {
  const BodyId body = read_body_id(params);
  std::string material = params.text("material", kMaxNameLength);
  return [body, material = std::move(material)](SessionCore& core, Participant&) -> ActionResult {
    const Status melted = core.run().simulation().melt_body(body, material);
    if (!melted) return refused(melted.errors());
    core.participants().forget_grabs_of(body);
    core.bodies_changed();
    return Json::object();
  };
}

SessionAction read_set_emitter(ObjectReader& params, Errors&) {
  std::string emitter = params.text("emitter", kMaxNameLength);
  const bool open = params.boolean("open");
  return [emitter = std::move(emitter), open](SessionCore& core, Participant&) -> ActionResult {
    const Status set = core.run().simulation().set_emitter(emitter, open);
    if (!set) return refused(set.errors());
    return Json::object();
  };
}

SessionAction read_set_gravity(ObjectReader& params, Errors&) {
  const Vec3 gravity = params.vector("gravity", kAnyMin, kAnyMax);
  return [gravity](SessionCore& core, Participant&) -> ActionResult {
    const Status set = core.run().simulation().set_gravity(gravity);
    if (!set) return refused(set.errors());
    core.description_changed();
    return Json::object();
  };
}

ActionResult set_interface(SessionCore& core, const Json& value) {
  const Result<InterfaceDescription> interface = read_interface(value, "/interface");
  if (!interface) return refused(interface.errors());
  const Status set = core.run().simulation().set_interface(interface.value());
  if (!set) return refused(set.errors());
  return Json::object();
}

SessionAction read_set_interface(ObjectReader& params, Errors&) {
  const Json* interface = params.member("interface", true);
  if (interface == nullptr) return {};
  return [interface = *interface](SessionCore& core, Participant&) {
    return set_interface(core, interface);
  };
}

SessionAction read_apply_force(ObjectReader& params, Errors&) {
  const BodyId body = read_body_id(params);
  const Vec3 force = params.vector("force", kAnyMin, kAnyMax);
  const Real duration = params.real("duration", kAnyMin, kAnyMax);
  return [body, force, duration](SessionCore& core, Participant&) -> ActionResult {
    const Status applied = core.run().simulation().apply_force(body, force, duration);
    if (applied) return Json::object();
    if (applied.errors().front().code == "limit_reached") {
      return limit_reached("applied_forces", kMaxAppliedForces);
    }
    return refused(applied.errors());
  };
}

constexpr Method kMethods[] = {
    {"world.add_body", read_add_body},       {"world.remove_body", read_remove_body},
    {"world.melt_body", read_melt_body},     {"world.set_emitter", read_set_emitter},
    {"world.set_gravity", read_set_gravity}, {"world.set_interface", read_set_interface},
    {"world.apply_force", read_apply_force},
};

}  // namespace

std::span<const Method> world_methods() {
  return kMethods;
}

}  // namespace vat
