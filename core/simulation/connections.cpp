#include "core/simulation/connections.h"
#include "core/contact/scratch.h"
#include "core/laws/contact_damping.h"

#include "core/contact/restitution.h"
#include "core/laws/connection.h"
#include "core/laws/lennard_jones.h"
#include "core/laws/pair_direction.h"
#include "core/laws/vat_motion.h"
#include "core/simulation/measure.h"
#include "core/solid/spring_changes.h"
#include "core/support/check.h"

namespace vat {
namespace {

/// Selects every n-th of `total` elements, so that there are at most `most`.
class StridedSelection {
 public:
  StridedSelection(std::size_t total, std::size_t most, ConnectionList& list) : list_(list) {
    list_.total = total;
    list_.every = most == 0 ? total + 1 : std::max<std::size_t>(1, (total + most - 1) / most);
  }
  template <class Make>
  void add(Make&& make) {
    if (next_++ % list_.every == 0 && list_.every <= list_.total) list_.sample.push_back(make());
  }

 private:
  ConnectionList& list_;
  std::size_t next_ = 0;
};

struct Pair {
  Index a = 0;
  Index b = 0;
  Real value = 0;
};

ConnectedParticle particle_of(const Model& model, Index particle) {
  VAT_CHECK(particle < model.particle_count);
  const ModelBody& body = model.bodies[model.body[particle]];
  const Index place = particle - body.particles.begin;
  const bool is_numbered = body.sample && !body.sample->numbers.empty();
  return {body.id, is_numbered ? body.sample->numbers[place] : place};
}

ConnectedPair make_connection(const Model& model, const Pair& pair) {
  return {particle_of(model, pair.a), particle_of(model, pair.b), pair.value};
}

bool is_wanted(const Model& model, const ConnectionQuery& query, Index a, Index b) {
  if (!query.body) return true;
  return model.bodies[model.body[a]].id == *query.body ||
         model.bodies[model.body[b]].id == *query.body;
}

/// Calls f(particle, end) for each spring that is not torn.
template <class F>
void for_each_spring(const Model& model, const Configuration& at, const ConnectionQuery& query,
                     F&& f) {
  for (const ModelBody& body : model.bodies) {
    if (body.kind != BodyKind::deformable || (query.body && body.id != *query.body)) continue;
    for (Index i = body.particles.begin; i < body.particles.end; ++i) {
      for (Index s = model.spring_own_begin[i]; s < model.spring_begin[i + 1]; ++s) {
        if (at.springs.empty() || !at.springs[s].is_torn) f(i, s);
      }
    }
  }
}

Real strain_of(const Model& model, const Configuration& at, Index i, Index end) {
  const SpringEnd spring = present_spring(model, at, end);
  const Real length = (at.position[i] - at.position[spring.other]).norm();
  return spring.rest_length > 0 ? length / spring.rest_length - 1 : 0;
}

void list_springs(const Model& model, const Configuration& at, const ConnectionQuery& query,
                  ConnectionList& list) {
  std::size_t total = 0;
  for_each_spring(model, at, query, [&](Index, Index) { ++total; });
  StridedSelection thinned(total, query.max_count, list);
  for_each_spring(model, at, query, [&](Index i, Index s) {
    thinned.add([&] {
      return make_connection(model, {i, model.spring_ends[s].other, strain_of(model, at, i, s)});
    });
  });
}

/// The force along the line between the particles [N]; negative for attraction.
Real force_of(const StepContext& c, const Contact& contact) {
  if (contact.layer > 0) {
    return layer_push(contact.stiffness, contact.layer, contact.threshold, contact.distance);
  }
  const Vec3 n = pair_direction(contact.x, contact.distance, contact.self, contact.other,
                                c.model.scene.dimensions);
  const Real speed =
      (c.configuration.velocity[contact.self] - c.configuration.velocity[contact.other]).dot(n);
  Real damping = contact.damping;
  if (contact.damping_ratio > 0) {
    const ContactMobility mobilities{c.model, c.work, c.configuration, c.step};
    damping = damping_for(contact.damping_ratio, contact.stiffness,
                          mobilities.along(contact.self, n) + mobilities.along(contact.other, -n));
  }
  const Real push =
      connection_push(contact.stiffness, damping, contact.threshold, contact.distance, speed);
  return std::max(push, Real{0});
}

void find_pushes(const ForceModel& f, Configuration& at, Real time, const ConnectionQuery& query,
                 std::vector<Pair>& found) {
  const Model& model = f.model;
  if (model.contact_reach <= 0 || !model.bodies_push) return;
  Forces forces;
  const StepContext c = evaluate_inner_forces(f, at, time, forces);
  for (Index i = 0; i < model.particle_count; ++i) {
    f.work.of<ContactForceScratch>().contacts.for_each(model, at, i, [&](const Contact& contact) {
      if (contact.other < i || !is_wanted(model, query, i, contact.other)) return;
      const Real force = force_of(c, contact);
      if (force != 0) found.push_back({i, contact.other, force});
    });
  }
}

void find_projected(const std::vector<ContactImpulse>& contacts, const Model& model,
                    const ConnectionQuery& query, std::vector<Pair>& found) {
  for (const ContactImpulse& contact : contacts) {
    if (contact.other < kWallCount) continue;
    const auto other = static_cast<Index>(contact.other - kWallCount);
    if (!is_wanted(model, query, contact.particle, other)) continue;
    const Real force = (contact.drift + contact.finish).norm();
    if (force > 0) found.push_back({contact.particle, other, force});
  }
}

}  // namespace

Connections find_connections(const ForceModel& force_model, Configuration configuration, Real time,
                             const std::vector<ContactImpulse>& projected, const Model& stepped,
                             const ConnectionQuery& query) {
  Connections connections;
  list_springs(force_model.model, configuration, query, connections.springs);
  std::vector<Pair> pushes;
  find_pushes(force_model, configuration, time, query, pushes);
  std::vector<Pair> kept_apart;
  find_projected(projected, stepped, query, kept_apart);
  StridedSelection thinned(pushes.size() + kept_apart.size(), query.max_count,
                           connections.contacts);
  for (const Pair& pair : pushes) {
    thinned.add([&] { return make_connection(force_model.model, pair); });
  }
  for (const Pair& pair : kept_apart) {
    thinned.add([&] { return make_connection(stepped, pair); });
  }
  return connections;
}

}  // namespace vat
