#include "core/state/body_state.h"

#include <algorithm>
#include <span>
#include <tuple>

#include "core/laws/vat_motion.h"
#include "core/support/check.h"

namespace vat {

namespace {

/// Returns whether the springs of both bodies join the same particles.
bool have_same_springs(const Placed& from, const Placed& to) {
  for (Index k = 0; k < from.body.particles.size(); ++k) {
    const auto ends = [k](const Placed& placed) {
      const Index i = placed.body.particles.begin + k;
      return std::span(placed.model.spring_ends)
          .subspan(placed.model.spring_begin[i],
                   placed.model.spring_begin[i + 1] - placed.model.spring_begin[i]);
    };
    const auto join_same = [&](const SpringEnd& a, const SpringEnd& b) {
      return a.other - from.body.particles.begin == b.other - to.body.particles.begin;
    };
    if (!std::ranges::equal(ends(from), ends(to), join_same)) return false;
  }
  return true;
}

}  // namespace

void carry_over(const Placed& from, const Configuration& source, const Placed& to,
                const std::optional<std::vector<Index>>& kept, Configuration& target) {
  const Index first = from.body.particles.begin;
  const Index new_first = to.body.particles.begin;
  VAT_CHECK(kept || from.body.particles.size() == to.body.particles.size());
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
             !target.springs.empty() && have_same_springs(from, to)) {
    const Index end = from.model.spring_begin[first];
    const auto ends = from.model.spring_begin[from.body.particles.end] - end;
    std::copy_n(source.springs.begin() + end, ends,
                target.springs.begin() + to.model.spring_begin[new_first]);
  }
}

namespace {

/// Calls f(body of the part, same body of the whole).
template <class F>
void for_each_shared_body(const Model& part, const Model& whole, F&& f) {
  std::size_t w = 0;
  for (const ModelBody& body : part.bodies) {
    while (whole.bodies[w].id != body.id) VAT_CHECK(++w < whole.bodies.size());
    f(body, whole.bodies[w]);
  }
}

/// For each body of the whole, the beginning of its particles in the part; kNowhere if the part
/// does not have it.
constexpr Index kNowhere = ~Index{0};
std::vector<Index> beginnings(const Model& part, const Model& whole) {
  std::vector<Index> begins(whole.bodies.size(), kNowhere);
  for_each_shared_body(part, whole, [&](const ModelBody& body, const ModelBody& same) {
    begins[static_cast<std::size_t>(&same - whole.bodies.data())] = body.particles.begin;
  });
  return begins;
}

/// For each body of the part, the beginning of its particles in the whole.
std::vector<Index> beginnings_in_whole(const Model& part, const Model& whole) {
  std::vector<Index> begins;
  for_each_shared_body(part, whole, [&](const ModelBody&, const ModelBody& same) {
    begins.push_back(same.particles.begin);
  });
  return begins;
}

/// The index of a particle in another model, in which the particles of its body begin at
/// begins[body].
Index moved(const Model& from, const std::vector<Index>& begins, Index particle) {
  const Index body = from.body[particle];
  if (begins[body] == kNowhere) return kNowhere;
  return begins[body] + (particle - from.bodies[body].particles.begin);
}

/// Appends the contacts that exist in the other model.
void append_contacts(const Model& from, const std::vector<ContactImpulse>& source,
                     const std::vector<Index>& begins, std::vector<ContactImpulse>& target) {
  for (ContactImpulse contact : source) {
    contact.particle = moved(from, begins, contact.particle);
    if (contact.particle == kNowhere) continue;
    if (contact.other >= kWallCount) {
      const Index other = moved(from, begins, static_cast<Index>(contact.other - kWallCount));
      if (other == kNowhere) continue;
      contact.other = std::uint64_t{kWallCount} + other;
    }
    target.push_back(contact);
  }
}

}  // namespace

Forces no_forces(const Model& model) {
  Forces forces;
  forces.particle.assign(model.particle_count, Vec3::Zero());
  forces.rigid_force.assign(model.rigid_bodies.size(), Vec3::Zero());
  forces.rigid_torque.assign(model.rigid_bodies.size(), Vec3::Zero());
  return forces;
}

Configuration part_of(const Model& whole, const Configuration& source, const Model& part) {
  VAT_CHECK(source.position.size() == whole.particle_count);
  Configuration target;
  target.position.resize(part.particle_count);
  target.velocity.resize(part.particle_count);
  target.rigid.resize(part.rigid_bodies.size());
  if (part.is_incompressible) target.pressure.resize(part.liquid_count);
  if (part.springs_change) target.springs.resize(part.spring_ends.size());
  for_each_shared_body(part, whole, [&](const ModelBody& body, const ModelBody& same) {
    carry_over({whole, same}, source, {part, body}, {}, target);
  });
  append_contacts(whole, source.contacts, beginnings(part, whole), target.contacts);
  return target;
}

void write_part(const Model& part, const Configuration& source, const Model& whole,
                Configuration& target) {
  for_each_shared_body(part, whole, [&](const ModelBody& body, const ModelBody& same) {
    carry_over({part, body}, source, {whole, same}, {}, target);
  });
}

void add_contacts_of_part(const Model& part, const Configuration& source, const Model& whole,
                          Configuration& target) {
  append_contacts(part, source.contacts, beginnings_in_whole(part, whole), target.contacts);
  std::ranges::sort(target.contacts, {}, [](const ContactImpulse& contact) {
    return std::tuple(contact.particle, contact.other);
  });
}

Forces forces_of_part(const Model& whole, const Forces& source, const Model& part) {
  VAT_CHECK(source.particle.size() == whole.particle_count);
  Forces target = no_forces(part);
  if (!source.transport.empty()) target.transport.resize(part.liquid_count, Vec3::Zero());
  for_each_shared_body(part, whole, [&](const ModelBody& body, const ModelBody& same) {
    const auto count = static_cast<std::ptrdiff_t>(body.particles.size());
    std::copy_n(source.particle.begin() + same.particles.begin, count,
                target.particle.begin() + body.particles.begin);
    if (body.kind == BodyKind::rigid) {
      target.rigid_force[body.rigid] = source.rigid_force[same.rigid];
      target.rigid_torque[body.rigid] = source.rigid_torque[same.rigid];
    } else if (body.kind == BodyKind::liquid && !source.transport.empty()) {
      std::copy_n(source.transport.begin() + same.particles.begin, count,
                  target.transport.begin() + body.particles.begin);
    }
  });
  return target;
}

}  // namespace vat
