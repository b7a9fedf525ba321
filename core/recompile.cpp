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

/// Copies the state of a body from one model's columns to another's; what its sample has beyond
/// `kept`, where that is given, is where it starts already.
void carry_over(const Placed& from, const Configuration& source, const Placed& to,
                const std::optional<std::vector<Index>>& kept, Configuration& target) {
  const Index first = from.body.particles.begin;
  const Index new_first = to.body.particles.begin;
  if (kept) {
    for (std::size_t k = 0; k < kept->size(); ++k) {
      target.position[new_first + k] = source.position[first + (*kept)[k]];
      target.velocity[new_first + k] = source.velocity[first + (*kept)[k]];
      if (source.pressure.empty()) continue;
      target.pressure[new_first + k] = source.pressure[first + (*kept)[k]];
    }
    return;
  }
  const auto count = static_cast<std::ptrdiff_t>(from.body.particles.size());
  std::copy_n(source.position.begin() + first, count, target.position.begin() + new_first);
  std::copy_n(source.velocity.begin() + first, count, target.velocity.begin() + new_first);
  if (from.body.kind == BodyKind::liquid && !source.pressure.empty()) {
    std::copy_n(source.pressure.begin() + first, count, target.pressure.begin() + new_first);
  }
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

/// Lets go what of the held particles is gone; false where the one in the hand is.
bool keep_held(const std::vector<Index>& kept, Grab& grab) {
  const auto place = [&](Index particle) {
    const auto found = std::ranges::lower_bound(kept, particle);
    const bool is_kept = found != kept.end() && *found == particle;
    return is_kept ? std::optional(static_cast<Index>(found - kept.begin())) : std::nullopt;
  };
  const std::optional<Index> in_hand = place(grab.particle);
  if (!in_hand) return false;
  grab.particle = *in_hand;
  const std::vector<Index> held = std::move(grab.held);
  grab.held.clear();
  for (const Index particle : held) {
    if (const auto found = place(particle)) grab.held.push_back(*found);
  }
  grab.held_mass *= static_cast<Real>(grab.held.size()) / static_cast<Real>(held.size());
  return true;
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

void Simulation::Impl::recompile(Scene scene, const std::vector<BodyId>& ids, Samples samples,
                                 const std::vector<std::optional<std::vector<Index>>>& kept) {
  for (std::size_t b = 0; b < ids.size(); ++b) {
    const ModelBody* known = find(ids[b]);
    if (samples[b] == nullptr && known != nullptr) samples[b] = known->sample;
  }
  auto new_model = compile(std::move(scene), ids, std::move(samples));
  State new_state = initial_state(*new_model);
  Controls old_controls = controls;
  for (std::size_t b = 0; b < ids.size(); ++b) {
    const ModelBody* known = find(ids[b]);
    if (known == nullptr) continue;
    const auto& kept_of_body = kept.empty() ? std::nullopt : kept[b];
    carry_over({*model, *known}, state.now, {*new_model, new_model->bodies[b]}, kept_of_body,
               new_state.now);
    if (!kept_of_body) continue;
    std::erase_if(old_controls.grabs, [&](Grab& grab) {
      return grab.body_id == ids[b] && !keep_held(*kept_of_body, grab);
    });
  }
  new_state.step_count = state.step_count;
  new_state.emitted = state.emitted;
  new_state.drained = state.drained;
  Controls new_controls = rebind(std::move(old_controls), *model, *new_model);
  GuardBounds new_bounds = guard_bounds(*new_model);
  StepBounds new_step_bounds = find_step_bounds(*new_model);
  forget_samples(*new_model);
  adopt({std::move(new_model), std::move(new_state), std::move(new_controls)},
        std::move(new_bounds), std::move(new_step_bounds));
}

void Simulation::Impl::recompile(Scene scene, const std::vector<BodyId>& ids) {
  recompile(std::move(scene), ids, Samples(ids.size()), {});
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
    const std::size_t springs = body.sample ? body.sample->springs.size() : 0;
    present.bodies.push_back({part(state.now.position), part(model->radius), springs});
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
  recompile(std::move(scene), ids(), std::move(samples), {});
}

}  // namespace vat
