// world.*: ranges are those of the core, which names them in its errors

#include <optional>
#include <string>
#include <utility>

#include "core/limits.h"
#include "protocol/scene/scene_json.h"
#include "protocol/scene/scene_parts.h"
#include "server/methods/handlers.h"
#include "server/methods/parts.h"
#include "server/session/core/scene_loading.h"

namespace vat {
namespace {

/// Returns a body as `state.query` contains it: the pose of a rigid body, the particles of others.
Result<BodyMotion> read_motion(const Json& value, const std::string& path) {
  Errors errors;
  ObjectReader reader(value, path, errors);
  BodyMotion motion;
  if (reader.has("positions") || reader.has("velocities")) {
    motion.positions = scene_parts::read_vectors(reader, "positions", kAnyMax, true, errors);
    motion.velocities = scene_parts::read_vectors(reader, "velocities", kAnyMax, true, errors);
  } else {
    RigidPose pose;
    pose.center_of_mass = reader.vector("center_of_mass", kAnyMin, kAnyMax);
    pose.orientation = Quat::Identity();
    if (const Json* orientation = reader.member("orientation", true)) {
      pose.orientation =
          scene_parts::to_orientation(*orientation, reader.path_of("orientation"), errors);
    }
    pose.velocity = reader.vector("velocity", kAnyMin, kAnyMax);
    pose.angular_velocity = reader.vector("angular_velocity", kAnyMin, kAnyMax);
    motion.pose = pose;
  }
  reader.refuse_unknown();
  if (!errors.empty()) return errors;
  return motion;
}

ActionResult add_body(SessionCore& core, const Json& value, const Json* state) {
  const Result<BodyDescription> body = read_body(value, "/body", refuse_mesh_file);
  if (!body) return refused(body.errors());
  const Result<BodyMotion> motion = state == nullptr ? BodyMotion() : read_motion(*state, "/state");
  if (!motion) return refused(motion.errors());
  BodyId id = 0;
  auto error = change_within_limits(core, [&](Simulation& simulation) -> Status {
    const Result<BodyId> added = state == nullptr
                                     ? simulation.add_body(body.value())
                                     : simulation.add_body(body.value(), motion.value());
    if (!added) return added.errors();
    id = added.value();
    return {};
  });
  if (error) return *std::move(error);
  core.start_epoch();
  return Json{{"body", id}};
}

ActionResult set_interface(SessionCore& core, const Json& value) {
  const Result<InterfaceDescription> interface = read_interface(value, "/interface");
  if (!interface) return refused(interface.errors());
  const Status set = core.run().simulation().set_interface(interface.value());
  if (!set) return refused(set.errors());
  return Json::object();
}

}  // namespace

SessionAction read_world_add_body(ObjectReader& params, Errors&) {
  const Json* body = params.member("body", true);
  if (body == nullptr) return {};
  std::optional<Json> state;
  if (const Json* given = params.member("state")) state = *given;
  return [body = *body, state = std::move(state)](SessionCore& core, Participant&) {
    return add_body(core, body, state ? &*state : nullptr);
  };
}

SessionAction read_world_remove_body(ObjectReader& params, Errors& errors) {
  const BodyId body = read_body_id(params, errors);
  return [body](SessionCore& core, Participant&) -> ActionResult {
    const Status removed = core.run().simulation().remove_body(body);
    if (!removed) return refused(removed.errors());
    core.run().admit_change();  // less
    core.participants().forget_grabs_of(body);
    core.start_epoch();
    return Json::object();
  };
}

SessionAction read_world_melt_body(ObjectReader& params, Errors& errors) {
  const BodyId body = read_body_id(params, errors);
  std::string material = params.text("material", kMaxNameLength);
  return [body, material = std::move(material)](SessionCore& core, Participant&) -> ActionResult {
    const Status melted = core.run().simulation().melt_body(body, material);
    if (!melted) return refused(melted.errors());
    core.participants().forget_grabs_of(body);
    core.start_epoch();
    return Json::object();
  };
}

SessionAction read_world_set_emitter(ObjectReader& params, Errors&) {
  std::string emitter = params.text("emitter", kMaxNameLength);
  const bool open = params.boolean("open");
  return [emitter = std::move(emitter), open](SessionCore& core, Participant&) -> ActionResult {
    const Status set = core.run().simulation().set_emitter(emitter, open);
    if (!set) return refused(set.errors());
    return Json::object();
  };
}

SessionAction read_world_set_gravity(ObjectReader& params, Errors&) {
  const Vec3 gravity = params.vector("gravity", kAnyMin, kAnyMax);
  return [gravity](SessionCore& core, Participant&) -> ActionResult {
    const Status set = core.run().simulation().set_gravity(gravity);
    if (!set) return refused(set.errors());
    core.notifier().mark_description();
    return Json::object();
  };
}

SessionAction read_world_set_interface(ObjectReader& params, Errors&) {
  return read_action_on("interface", params, set_interface);
}

SessionAction read_world_apply_force(ObjectReader& params, Errors& errors) {
  const BodyId body = read_body_id(params, errors);
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

}  // namespace vat
