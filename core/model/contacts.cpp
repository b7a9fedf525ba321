#include "core/model/contacts.h"

#include <algorithm>

#include "core/neighbours/uniform_grid.h"

namespace vat {
namespace {

ContactLaw make_law(const SpringConstants& constants, Real threshold) {
  return {constants.stiffness, constants.damping, threshold};
}

void fill_laws(Model& model) {
  const Scene& scene = model.scene;
  const std::size_t count = scene.materials.size();
  model.contact_laws.assign(count * count, make_law(scene.default_interface, 0));
  model.wall_laws.assign(count, make_law(scene.default_interface, 0));
  const auto index_of = [&](const std::string& name) {
    return static_cast<std::size_t>(std::ranges::find(scene.materials, name, &Material::name) -
                                    scene.materials.begin());
  };
  for (const InterfaceDescription& interface : scene.interfaces) {
    const ContactLaw law = make_law(interface.constants, interface.threshold.value_or(0));
    const auto& [first, second] = interface.materials;
    if (first == kVatMaterial || second == kVatMaterial) {
      model.wall_laws[index_of(first == kVatMaterial ? second : first)] = law;
    } else {
      model.contact_laws[index_of(first) * count + index_of(second)] = law;
      model.contact_laws[index_of(second) * count + index_of(first)] = law;
    }
  }
  for (const Material& material : scene.materials) {
    model.self_contacts.push_back(material.self_contact);
  }
}

/// Whether two bodies can be joined by dynamic connections. Liquids of one material are one liquid.
bool can_touch(const ModelBody& a, const ModelBody& b) {
  return a.kind != BodyKind::liquid || b.kind != BodyKind::liquid || a.material != b.material;
}

void find_reach(Model& model) {
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
      if (!can_touch(first, second)) continue;
      const Real threshold = model.contact_law(first.material, second.material).threshold;
      const Real reach = threshold > 0 ? threshold : greatest_radius[a] + greatest_radius[b];
      model.contact_reach = std::max(model.contact_reach, reach);
      if (first.kind == BodyKind::liquid && second.kind == BodyKind::liquid) {
        model.liquids_touch = true;
      }
    }
  }
}

/// Adds to `excluded` the particles of `body` that start closer to one another than their radii.
void exclude_close_pairs(const Model& model, const ModelBody& body,
                         std::vector<std::vector<Index>>& excluded) {
  const std::vector<Vec3>& points = body.sample->positions;
  const std::vector<Real>& radii = body.sample->radii;
  const Real reach = 2 * *std::ranges::max_element(radii);
  UniformGrid grid;
  grid.build(points, reach);
  for (Index i = 0; i < points.size(); ++i) {
    grid.for_each_run(points[i], reach, [&](Index begin, Index end) {
      for (Index slot = begin; slot < end; ++slot) {
        const Index j = grid.order()[slot];
        const Real threshold = radii[i] + radii[j];
        if (j != i && (points[i] - points[j]).squaredNorm() < threshold * threshold) {
          excluded[body.particles.begin + i].push_back(body.particles.begin + j);
        }
      }
    });
  }
  for (Index i = body.particles.begin; i < body.particles.end; ++i) {
    for (Index s = model.spring_begin[i]; s < model.spring_begin[i + 1]; ++s) {
      excluded[i].push_back(model.spring_ends[s].other);
    }
  }
}

void find_exclusions(Model& model) {
  std::vector<std::vector<Index>> excluded(model.free_count);
  for (const ModelBody& body : model.bodies) {
    if (body.kind == BodyKind::deformable && model.self_contacts[body.material]) {
      exclude_close_pairs(model, body, excluded);
    }
  }
  model.exclusion_begin.push_back(0);
  for (std::vector<Index>& of_particle : excluded) {
    std::ranges::sort(of_particle);
    of_particle.erase(std::unique(of_particle.begin(), of_particle.end()), of_particle.end());
    model.exclusions.insert(model.exclusions.end(), of_particle.begin(), of_particle.end());
    model.exclusion_begin.push_back(static_cast<Index>(model.exclusions.size()));
  }
}

}  // namespace

void compile_contacts(Model& model) {
  fill_laws(model);
  find_reach(model);
  if (model.has_self_contact) find_exclusions(model);
}

}  // namespace vat
