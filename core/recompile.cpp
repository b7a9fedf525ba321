// What a simulation keeps when its bodies change between two steps.

#include <algorithm>

#include "core/forces/vat_motion.h"
#include "core/model/compile.h"
#include "core/scene/melting.h"
#include "core/simulation_impl.h"

namespace vat {
namespace {

/// One of a scene's models, with one of its bodies.
struct Placed {
  const Model& model;
  const ModelBody& body;
};

/// Copies the state of a body from one model's columns to another's.
void carry_over(const Placed& from, const Configuration& source, const Placed& to,
                Configuration& target) {
  const Index first = from.body.particles.begin;
  const Index new_first = to.body.particles.begin;
  const auto count = static_cast<std::ptrdiff_t>(from.body.particles.size());
  std::copy_n(source.position.begin() + first, count, target.position.begin() + new_first);
  std::copy_n(source.velocity.begin() + first, count, target.velocity.begin() + new_first);
  if (from.body.kind == BodyKind::rigid) {
    target.rigid[to.body.rigid] = source.rigid[from.body.rigid];
  } else if (to.body.kind == BodyKind::deformable && !source.springs.empty() &&
             !target.springs.empty()) {
    const Index end = from.model.spring_begin[first];
    const auto ends = from.model.spring_begin[from.body.particles.end] - end;
    std::copy_n(source.springs.begin() + end, ends,
                target.springs.begin() + to.model.spring_begin[new_first]);
  }
}

/// Those of `controls` whose bodies stay, bound to the places of their bodies in `model`. A body
/// that has melted is let go.
Controls rebind(Controls controls, const Model& before, const Model& model) {
  const auto bind = [&](auto& control) {
    const auto found = std::ranges::find(model.bodies, control.body_id, &ModelBody::id);
    if (found == model.bodies.end()) return false;
    const bool is_same_kind = found->kind == before.bodies[control.body].kind;
    control.body = static_cast<Index>(found - model.bodies.begin());
    return is_same_kind;
  };
  std::erase_if(controls.grabs, [&](Grab& grab) { return !bind(grab); });
  std::erase_if(controls.applied_forces, [&](AppliedForce& applied) { return !bind(applied); });
  return controls;
}

}  // namespace

void Simulation::Impl::recompile(Scene scene, const std::vector<BodyId>& ids, Samples samples) {
  for (std::size_t b = 0; b < ids.size(); ++b) {
    const ModelBody* known = find(ids[b]);
    if (samples[b] == nullptr && known != nullptr) samples[b] = known->sample;
  }
  auto new_model = compile(std::move(scene), ids, std::move(samples));
  State new_state = initial_state(*new_model);
  for (const ModelBody& body : new_model->bodies) {
    const ModelBody* known = find(body.id);
    if (known == nullptr) continue;
    carry_over({*model, *known}, state.now, {*new_model, body}, new_state.now);
  }
  new_state.step_count = state.step_count;
  Controls new_controls = rebind(controls, *model, *new_model);
  GuardBounds new_bounds = guard_bounds(*new_model);
  StepBounds new_step_bounds = find_step_bounds(*new_model);
  adopt({std::move(new_model), std::move(new_state), std::move(new_controls)},
        std::move(new_bounds), std::move(new_step_bounds));
}

void Simulation::Impl::recompile(Scene scene, const std::vector<BodyId>& ids) {
  recompile(std::move(scene), ids, Samples(ids.size()));
}

std::vector<BodyId> Simulation::Impl::ids() const {
  std::vector<BodyId> ids;
  for (const ModelBody& body : model->bodies) ids.push_back(body.id);
  return ids;
}

Present Simulation::Impl::present() const {
  Present present;
  for (const ModelBody& body : model->bodies) {
    const auto part = [&](const auto& column) {
      return std::span(column).subspan(body.particles.begin, body.particles.size());
    };
    present.bodies.push_back(
        {part(state.now.position), part(model->radius), body.sample->springs.size()});
  }
  if (model->scene.vat) present.vat_offset = vat_motion(*model->scene.vat, time()).offset;
  return present;
}

void Simulation::Impl::melt(const std::vector<MeltedBody>& bodies) {
  Scene scene = model->scene;
  Samples samples(scene.bodies.size());
  for (const MeltedBody& melting : bodies) {
    const ModelBody& body = model->bodies[melting.body];
    scene.bodies[melting.body] = melted(scene.bodies[melting.body], melting.into, body.mass);
    samples[melting.body] = std::make_shared<const SampledBody>(melted(*body.sample));
  }
  recompile(std::move(scene), ids(), std::move(samples));
}

}  // namespace vat
