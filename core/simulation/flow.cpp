// Inflow and outflow between two steps of a simulation.

#include <algorithm>

#include "core/model/compile.h"
#include "core/simulation/simulation_impl.h"
#include "core/support/check.h"

namespace vat {
namespace {

/// The change of one liquid body.
struct Change {
  std::vector<Index> kept;  ///< remaining particles, in ascending order
  SampledBody sample;       ///< sample of the remaining particles, followed by the new ones
};

/// The entries of a column that remain.
template <class T>
std::vector<T> selected(const std::vector<T>& column, const std::vector<Index>& kept) {
  std::vector<T> result;
  result.reserve(kept.size());
  for (const Index particle : kept) result.push_back(column[particle]);
  return result;
}

class Flow {
 public:
  Flow(const Model& model, const State& state)
      : model_(model), state_(state), changes_(model.bodies.size()) {}

  bool is_empty() const {
    return std::ranges::none_of(changes_, [](const auto& change) { return change.has_value(); });
  }
  std::uint64_t emitted() const { return emitted_; }
  std::uint64_t drained() const { return drained_; }
  const std::vector<std::optional<Change>>& changes() const { return changes_; }

  /// Removes liquid in drains, except particles in nozzles.
  void drain() {
    for (std::size_t b = 0; b < model_.bodies.size(); ++b) {
      const ModelBody& body = model_.bodies[b];
      if (body.kind != BodyKind::liquid) continue;
      std::vector<Index> kept;
      for (Index i = 0; i < body.particles.size(); ++i) {
        if (!is_drained(body.particles.begin + i)) kept.push_back(i);
      }
      if (kept.size() == body.particles.size()) continue;
      drained_ += body.particles.size() - kept.size();
      changes_[b] = change_of(body, std::move(kept));
    }
  }

  /// Frees particles that have left their nozzle.
  void set_free() {
    for (std::size_t b = 0; b < model_.bodies.size(); ++b) {
      const auto is_out = [&](const NozzleParticle& each) {
        return each.free_from <= state_.step_count;
      };
      if (std::ranges::none_of(model_.bodies[b].sample->in_nozzles, is_out)) continue;
      std::erase_if(change_at(b).sample.in_nozzles, is_out);
    }
  }

  /// Adds the layers that have entered their nozzle since the last step, at `before`.
  void emit(Real time, Real before) {
    for (std::size_t e = 0; e < model_.nozzles.size(); ++e) {
      if (!model_.scene.emitters[e].open) continue;
      const Nozzle& nozzle = model_.nozzles[e];
      const std::uint64_t first = state_.step_count == 0 ? 0 : nozzle.entered(before);
      const std::uint64_t end = nozzle.entered(time);
      if (first == end) continue;
      Change& change = change_at(body_of(e));
      for (std::uint64_t layer = first; layer < end; ++layer) {
        const std::size_t count = change.sample.positions.size() + nozzle.layer.size();
        if (count > model_.scene.emitters[e].most_particles) break;
        add_layer(e, layer, time, change.sample);
      }
    }
  }

 private:
  std::size_t body_of(std::size_t emitter) const {
    const auto found =
        std::ranges::find(model_.bodies, model_.scene.emitters[emitter].body, &ModelBody::name);
    return static_cast<std::size_t>(found - model_.bodies.begin());
  }

  bool is_drained(Index particle) const {
    if (model_.inverse_mass[particle] == 0) return false;
    const Vec3 place = model_.periodic.wrap(state_.now.position[particle]);
    return std::ranges::any_of(model_.scene.drains, [&](const Drain& drain) {
      return (place.array() >= drain.min.array()).all() &&
             (place.array() <= drain.max.array()).all();
    });
  }

  Change change_of(const ModelBody& body, std::vector<Index> kept) const {
    VAT_CHECK(body.sample != nullptr);
    const SampledBody& all = *body.sample;
    Change change;
    SampledBody& sample = change.sample;
    sample.positions = selected(all.positions, kept);
    sample.velocities = selected(all.velocities, kept);
    sample.masses = selected(all.masses, kept);
    sample.radii = selected(all.radii, kept);
    sample.next_number = std::max(all.next_number, body.particles.size());
    if (!all.numbers.empty()) {
      sample.numbers = selected(all.numbers, kept);
    } else if (kept.size() < body.particles.size()) {
      sample.numbers = kept;
    }
    for (NozzleParticle each : all.in_nozzles) {
      each.particle =
          static_cast<Index>(std::ranges::lower_bound(kept, each.particle) - kept.begin());
      sample.in_nozzles.push_back(each);
    }
    change.kept = std::move(kept);
    return change;
  }

  Change& change_at(std::size_t body) {
    if (!changes_[body]) {
      std::vector<Index> all(model_.bodies[body].particles.size());
      for (Index i = 0; i < all.size(); ++i) all[i] = i;
      changes_[body] = change_of(model_.bodies[body], std::move(all));
    }
    return *changes_[body];
  }

  void add_layer(std::size_t emitter, std::uint64_t layer, Real time, SampledBody& sample) {
    const Nozzle& nozzle = model_.nozzles[emitter];
    const BodyDescription& body = model_.scene.bodies[body_of(emitter)];
    const Vec3 way = nozzle.age(layer, time) * nozzle.velocity;
    const std::uint64_t free_from =
        first_step_from(time - nozzle.age(layer, time), model_.scene.numerics.step);
    for (const Vec3& place : nozzle.layer) {
      const bool some_are_gone = sample.next_number > sample.positions.size();
      if (some_are_gone) sample.numbers.push_back(sample.next_number);
      ++sample.next_number;
      if (free_from > state_.step_count) {
        sample.in_nozzles.push_back({static_cast<Index>(sample.positions.size()), free_from});
      }
      sample.positions.push_back(place + way);
      sample.velocities.push_back(nozzle.velocity);
      sample.masses.push_back(nozzle.mass);
      sample.radii.push_back(body.radius.value_or(body.spacing / 2));
    }
    emitted_ += nozzle.layer.size();
  }

  const Model& model_;
  const State& state_;
  std::vector<std::optional<Change>> changes_;
  std::uint64_t emitted_ = 0;
  std::uint64_t drained_ = 0;
};

/// Contacts by projection with the new indices of solids. Flowing liquids have no such contacts.
std::vector<ContactImpulse> moved(const std::vector<ContactImpulse>& contacts, Index before,
                                  Index now) {
  std::vector<ContactImpulse> result;
  for (ContactImpulse contact : contacts) {
    if (contact.particle < before) continue;
    contact.particle = contact.particle - before + now;
    if (contact.other >= kWallCount) {
      if (contact.other - kWallCount < before) continue;
      contact.other = contact.other - before + now;
    }
    result.push_back(contact);
  }
  return result;
}

}  // namespace

void SimulationImpl::flow() {
  Flow flow(*model, state);
  const std::uint64_t step = state.step_count;
  if (!model->scene.drains.empty() && step % steps_per_tick() == 0) flow.drain();
  flow.set_free();
  flow.emit(time(), step == 0 ? 0 : static_cast<Real>(step - 1) * step_size());
  if (flow.is_empty()) return;
  if (sleepers) {  // the indices below are those of a model of all bodies
    wake_all();
    this->flow();
    return;
  }

  Samples samples(model->bodies.size());
  std::vector<std::optional<std::vector<Index>>> kept(model->bodies.size());
  for (std::size_t b = 0; b < samples.size(); ++b) {
    if (!flow.changes()[b]) continue;
    samples[b] = std::make_shared<const SampledBody>(flow.changes()[b]->sample);
    kept[b] = flow.changes()[b]->kept;
  }
  const StepHistory history = state.history;
  const Index liquid_before = model->liquid_count;
  std::vector<ContactImpulse> contacts = state.now.contacts;
  const std::uint64_t emitted = flow.emitted();
  const std::uint64_t drained = flow.drained();
  recompile(model->scene, ids(), std::move(samples), kept);
  state.history = history;
  state.now.contacts = moved(contacts, liquid_before, model->liquid_count);
  state.emitted += emitted;
  state.drained += drained;
}

}  // namespace vat
