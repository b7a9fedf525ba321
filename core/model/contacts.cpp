#include "core/model/compile_parts.h"

#include <algorithm>
#include <span>
#include <utility>

#include "core/laws/contact_damping.h"
#include "core/neighbours/uniform_grid.h"
#include "core/scene/interface_table.h"
#include "core/support/check.h"

namespace vat {
namespace {

ContactLaw make_law(const InterfaceConstants& constants, Real threshold) {
  ContactLaw law{.threshold = threshold};
  switch (constants.law) {
    case InterfaceLaw::penalty:
      law.stiffness = constants.stiffness;
      law.damping = constants.damping;
      law.friction = constants.friction;
      if (constants.restitution) law.damping_ratio = damping_ratio_for(*constants.restitution);
      break;
    case InterfaceLaw::lennard_jones:
      law.stiffness = constants.stiffness;
      law.layer = constants.reach - 1;
      break;
    case InterfaceLaw::projection:
      law.is_projected = true;
      law.friction = constants.friction;
      law.restitution = constants.restitution.value_or(0);
      break;
    case InterfaceLaw::sph:  // coupled liquids have no contacts
      break;
  }
  return law;
}

void fill_laws(Model& model) {
  const Scene& scene = model.scene;
  const InterfaceTable table(scene.materials, scene.interfaces);
  const auto law = [&](std::optional<std::size_t> interface) -> ContactLaw {
    const InterfaceConstants& constants =
        interface ? scene.interfaces[*interface].constants : scene.default_interface;
    const Real threshold = interface ? scene.interfaces[*interface].threshold.value_or(0) : 0;
    return make_law(constants, threshold);
  };
  for (std::size_t a = 0; a < scene.materials.size(); ++a) {
    for (std::size_t b = 0; b < scene.materials.size(); ++b) {
      model.contact_laws.push_back(law(table.between(a, b)));
    }
    model.wall_laws.push_back(law(table.with_walls(a)));
    model.self_contacts.push_back(scene.materials[a].self_contact);
  }
  const auto has = [&](auto&& property) {
    return std::ranges::any_of(model.contact_laws, property) ||
           std::ranges::any_of(model.wall_laws, property);
  };
  model.has_friction =
      has([](const ContactLaw& each) { return each.friction > 0 && !each.is_projected; });
  model.has_restitution = has([](const ContactLaw& each) { return each.damping_ratio > 0; });
  model.has_layers = has([](const ContactLaw& each) { return each.layer > 0; });
  model.has_projection = has([](const ContactLaw& each) { return each.is_projected; });
  const auto pushes = [](const ContactLaw& each) { return !each.is_projected; };
  model.bodies_push = std::ranges::any_of(model.contact_laws, pushes);
  model.walls_push = std::ranges::any_of(model.wall_laws, pushes);
}

/// Returns whether dynamic connections can join two bodies. Liquids of one material are one liquid.
bool can_touch(const Model& model, const ModelBody& a, const ModelBody& b) {
  if (model.is_coupled && (a.kind == BodyKind::liquid || b.kind == BodyKind::liquid)) return false;
  return a.kind != BodyKind::liquid || b.kind != BodyKind::liquid || a.material != b.material;
}

void find_reach(Model& model) {
  VAT_CHECK(model.radius.size() == model.particle_count);
  std::vector<Real> greatest_radius(model.bodies.size(), 0);
  for (Index i = 0; i < model.particle_count; ++i) {
    Real& radius = greatest_radius[model.body[i]];
    radius = std::max(radius, model.radius[i]);
  }
  for (std::size_t a = 0; a < model.bodies.size(); ++a) {
    const ModelBody& first = model.bodies[a];
    if (first.kind == BodyKind::deformable && model.self_contacts[first.material]) {
      model.has_self_contact = true;
      model.contact_reach = std::max(model.contact_reach, 2 * greatest_radius[a]);
    }
    for (std::size_t b = 0; b < a; ++b) {
      const ModelBody& second = model.bodies[b];
      if (!can_touch(model, first, second)) continue;
      const ContactLaw& law = model.contact_law(first.material, second.material);
      const Real touching =
          law.threshold > 0 ? law.threshold : greatest_radius[a] + greatest_radius[b];
      const Real reach = touching * (1 + law.layer);
      model.contact_reach = std::max(model.contact_reach, reach);
      if (first.kind == BodyKind::liquid && second.kind == BodyKind::liquid) {
        model.liquids_touch = true;
      }
    }
  }
}

/// For each particle of a body, the particles that never collide with it.
using Excluded = std::vector<std::vector<Index>>;

bool has_exclusions(const Model& model, const ModelBody& body) {
  return body.kind == BodyKind::deformable && model.self_contacts[body.material];
}

/// Finds particles that are closer at the start than their radii, or joined by a spring; in
/// ascending order.
Excluded exclusions_of(const Model& model, const ModelBody& body) {
  const std::vector<Vec3>& points = body.sample->positions;
  const std::vector<Real>& radii = body.sample->radii;
  const Real reach = 2 * *std::ranges::max_element(radii);
  Excluded excluded(points.size());
  UniformGrid grid;
  grid.build(points, reach);
  for (Index i = 0; i < points.size(); ++i) {
    std::vector<Index>& own = excluded[i];
    grid.for_each_run(points[i], reach, [&](Index begin, Index end) {
      for (Index slot = begin; slot < end; ++slot) {
        const Index j = grid.order()[slot];
        const Real threshold = radii[i] + radii[j];
        if (j != i && (points[i] - points[j]).squaredNorm() < threshold * threshold) {
          own.push_back(body.particles.begin + j);
        }
      }
    });
    const Index particle = body.particles.begin + i;
    for (Index s = model.spring_begin[particle]; s < model.spring_begin[particle + 1]; ++s) {
      own.push_back(model.spring_ends[s].other);
    }
    std::ranges::sort(own);
    own.erase(std::unique(own.begin(), own.end()), own.end());
  }
  return excluded;
}

/// Collects the exclusions of all particles in sequence.
struct ExclusionLists {
  std::vector<Index> begin = {0};
  std::vector<Index> all;

  void add(std::span<const Index> of_particle) {
    all.insert(all.end(), of_particle.begin(), of_particle.end());
    begin.push_back(static_cast<Index>(all.size()));
  }
  void move_to(Model& model) && {
    model.exclusion_begin = std::move(begin);
    model.exclusions = std::move(all);
  }
};

void find_exclusions(Model& model) {
  std::vector<Excluded> of_bodies(model.bodies.size());
  for (std::size_t b = 0; b < model.bodies.size(); ++b) {
    const ModelBody& body = model.bodies[b];
    if (has_exclusions(model, body)) of_bodies[b] = exclusions_of(model, body);
  }
  ExclusionLists lists;
  for (Index i = 0; i < model.free_count; ++i) {
    const Index b = model.body[i];
    if (of_bodies[b].empty()) {
      lists.add({});
    } else {
      lists.add(of_bodies[b][i - model.bodies[b].particles.begin]);
    }
  }
  std::move(lists).move_to(model);
}

}  // namespace

void compile_contacts(Model& model) {
  fill_laws(model);
  find_reach(model);
  if (!model.scene.forces.contacts) model.contact_reach = 0;
  VAT_CHECK(std::isfinite(model.contact_reach));
  if (model.has_self_contact) find_exclusions(model);
}

void compile_contacts_of_moved(Model& model, const ModelBody& body) {
  if (!has_exclusions(model, body)) return;
  const Excluded own = exclusions_of(model, body);
  const auto known = [&](Index i) {
    return std::span(model.exclusions)
        .subspan(model.exclusion_begin[i], model.exclusion_begin[i + 1] - model.exclusion_begin[i]);
  };
  ExclusionLists lists;
  for (Index i = 0; i < model.free_count; ++i) {
    const bool is_own = i >= body.particles.begin && i < body.particles.end;
    lists.add(is_own ? std::span<const Index>(own[i - body.particles.begin]) : known(i));
  }
  std::move(lists).move_to(model);
}

}  // namespace vat
