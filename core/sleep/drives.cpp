#include "core/sleep/drives.h"

#include <algorithm>

#include "core/laws/vat_motion.h"
#include "core/support/check.h"

namespace vat {
namespace {

bool is_in_drain(const Model& model, const ModelBody& body, const Configuration& at) {
  for (Index i = body.particles.begin; i < body.particles.end; ++i) {
    const Vec3 place = model.periodic.wrap(at.position[i]);
    for (const Drain& drain : model.scene.drains) {
      if ((place.array() >= drain.min.array()).all() &&
          (place.array() <= drain.max.array()).all()) {
        return true;
      }
    }
  }
  return false;
}

}  // namespace

bool prevents_sleep(const Scene& scene, Real time) {
  if (scene.vat && moves_walls(*scene.vat, time)) return true;
  const auto is_moved = [](const BodyDescription& body) { return body.motion.has_value(); };
  if (std::ranges::any_of(scene.bodies, is_moved)) return true;
  if (scene.settling && time < scene.settling->until) return true;
  return std::ranges::any_of(
      scene.emitters, [&](const Emitter& emitter) { return emitter.open && time < emitter.until; });
}

bool is_driven(const Model& model, const State& state, const Controls& controls, Index b) {
  VAT_CHECK(b < model.bodies.size());
  const ModelBody& body = model.bodies[b];
  const auto is_of_body = [&](const auto& control) { return control.body == b; };
  if (std::ranges::any_of(controls.grabs, is_of_body)) return true;
  // Forces that have ended remain in the list until the end of the call.
  const auto pushes = [&](const AppliedForce& applied) {
    return is_of_body(applied) && applied.end_step > state.step_count;
  };
  if (std::ranges::any_of(controls.applied_forces, pushes)) return true;
  if (body.kind == BodyKind::rigid) {
    return model.rigid_bodies[body.rigid].is_held(state.step_count);
  }
  if (body.melts_at != kNever) return true;
  if (body.sample && !body.sample->in_nozzles.empty()) return true;
  return body.kind == BodyKind::liquid && !model.scene.drains.empty() &&
         is_in_drain(model, body, state.now);
}

}  // namespace vat
