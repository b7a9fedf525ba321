// The state that remains when bodies change between two steps.

#include <algorithm>

#include "core/laws/vat_motion.h"
#include "core/model/compile.h"
#include "core/sampling/melting.h"
#include "core/simulation/simulation_impl.h"
#include "core/state/body_state.h"
#include "core/stepping/step_plan.h"
#include "core/support/check.h"

namespace vat {
namespace {

/// Removes lost particles from a grab. Returns false if its grabbed particle is lost.
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

}  // namespace

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

void SimulationImpl::recompile(Scene scene, const std::vector<BodyId>& ids, Samples samples,
                               const std::vector<std::optional<std::vector<Index>>>& kept,
                               const std::vector<BodyId>& described_anew) {
  std::vector<bool> as_described(ids.size());
  VAT_CHECK(samples.size() == ids.size() && (kept.empty() || kept.size() == ids.size()));
  for (std::size_t b = 0; b < ids.size(); ++b) {
    const ModelBody* known = find(ids[b]);
    if (samples[b] != nullptr || known == nullptr || known->sample == nullptr) continue;
    const bool is_other = std::ranges::find(described_anew, ids[b]) != described_anew.end();
    if (is_other && known->is_as_described) continue;
    samples[b] = known->sample;
    as_described[b] = known->is_as_described;
  }
  auto new_model = compile(std::move(scene), ids, std::move(samples));
  for (std::size_t b = 0; b < ids.size(); ++b) {
    if (as_described[b]) new_model->bodies[b].is_as_described = true;
  }
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
  adopt({std::move(new_model), std::move(new_state), std::move(new_controls), nullptr},
        std::move(new_bounds), std::move(new_step_bounds));
}

void SimulationImpl::recompile(Scene scene, const std::vector<BodyId>& ids) {
  recompile(std::move(scene), ids, Samples(ids.size()), {});
}

void SimulationImpl::recompile_moved(std::size_t body, BodyDescription moved) {
  auto new_model = with_moved_body(*model, body, std::move(moved));
  GuardBounds new_bounds = guard_bounds(*new_model);
  StepBounds new_step_bounds = step_bounds_of_moved(*new_model, body, step_bounds);
  forget_samples(*new_model);
  State new_state;
  new_state.forces = no_forces(*new_model);
  if (model->scene.sleeping) new_state.slow_looks.assign(model->bodies.size(), 0);
  // Nothing fails from here on.
  new_state.now = std::move(state.now);
  new_state.now.contacts.clear();
  new_state.step_count = state.step_count;
  new_state.emitted = state.emitted;
  new_state.drained = state.drained;
  adopt({std::move(new_model), std::move(new_state), std::move(controls), nullptr},
        std::move(new_bounds), std::move(new_step_bounds));
}

std::vector<BodyId> SimulationImpl::ids() const {
  std::vector<BodyId> ids;
  for (const ModelBody& body : all().bodies) ids.push_back(body.id);
  return ids;
}

CurrentScene SimulationImpl::present() const {
  CurrentScene present;
  const Model& whole = all();
  for (const ModelBody& body : whole.bodies) {
    const auto part = [&](const auto& column) {
      return std::span(column).subspan(body.particles.begin, body.particles.size());
    };
    const std::size_t springs = body.sample ? body.sample->springs.size() : 0;
    present.bodies.push_back({part(all_now().position), part(whole.radius), springs});
  }
  if (whole.scene.vat) present.vat_offset = vat_motion(*whole.scene.vat, time()).offset;
  return present;
}

void SimulationImpl::melt(const std::vector<MeltedBody>& bodies) {
  Scene scene = model->scene;
  Samples samples(scene.bodies.size());
  for (const MeltedBody& melting : bodies) {
    VAT_CHECK(melting.body < model->bodies.size());
    const ModelBody& body = model->bodies[melting.body];
    VAT_CHECK(body.sample != nullptr);
    scene.bodies[melting.body] = melted(scene.bodies[melting.body], melting.into, body.mass);
    samples[melting.body] = std::make_shared<const SampledBody>(melted(*body.sample));
  }
  recompile(std::move(scene), ids(), std::move(samples), {});
}

}  // namespace vat
