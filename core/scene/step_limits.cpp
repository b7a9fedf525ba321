#include "core/scene/step_limits.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>

#include "core/support/check.h"

namespace vat {
namespace {

constexpr Real kSoundLimit = 0.96;     // c dt / h, velocity Verlet, cubic lattice, h = 2 spacings
constexpr Real kViscousLimit = 0.126;  // nu dt / h^2, the same, 2 / (greatest eigenvalue)
constexpr Real kVerletLimit = 2;

const Material& material_of(const Scene& scene, const BodyDescription& body) {
  return *std::ranges::find(scene.materials, body.material, &Material::name);
}

std::string body_path(std::size_t index) {
  return "/bodies/" + std::to_string(index);
}

/// Greatest bound of omega^2 over the body's free particles, and whether all springs are undamped.
struct SpringBound {
  Real omega2 = 0;
  bool undamped = true;
};

SpringBound bound_springs(const SampledBody& body) {
  std::vector<Real> stiffness(body.positions.size(), 0);
  SpringBound bound;
  for (const SampledSpring& spring : body.springs) {
    stiffness[spring.a] += spring.stiffness;
    stiffness[spring.b] += spring.stiffness;
    bound.undamped &= spring.damping == 0;
  }
  for (const Index fixed : body.fixed) stiffness[fixed] = 0;
  for (std::size_t i = 0; i < stiffness.size(); ++i) {
    bound.omega2 = std::max(bound.omega2, 2 * stiffness[i] / body.masses[i]);
  }
  return bound;
}

void limit_springs(const Scene& scene, const std::vector<SampledBody>& samples,
                   std::vector<StepLimit>& limits) {
  const Real z = undamped_limit(scene.numerics.integrator);
  for (std::size_t b = 0; b < samples.size(); ++b) {
    const SpringBound bound = bound_springs(samples[b]);
    if (bound.omega2 == 0) continue;
    if (z == 0 && bound.undamped) {
      limits.push_back({body_path(b), "undamped springs gain energy with this integrator", 0});
    } else if (z > 0) {
      limits.push_back(
          {body_path(b), "its springs may become unstable", z / std::sqrt(bound.omega2)});
    }
  }
}

/// What a contact has to move: a rigid body as a whole, of others one particle.
Real lightest(const BodyDescription& description, const SampledBody& body) {
  if (description.kind == BodyKind::rigid) {
    return std::accumulate(body.masses.begin(), body.masses.end(), Real{0});
  }
  return std::ranges::min(body.masses);
}

/// The lightest moving part by material; for liquids and solids apart, since liquids of one
/// material do not collide.
std::map<std::string, Real> lightest_by_material(const Scene& scene,
                                                 const std::vector<SampledBody>& samples) {
  std::map<std::string, Real> masses;
  for (std::size_t b = 0; b < samples.size(); ++b) {
    const Real mass = lightest(scene.bodies[b], samples[b]);
    const auto [entry, added] = masses.try_emplace(scene.bodies[b].material, mass);
    if (!added) entry->second = std::min(entry->second, mass);
  }
  return masses;
}

void limit_contacts(const Scene& scene, const std::vector<SampledBody>& samples,
                    std::vector<StepLimit>& limits) {
  const Real z = undamped_limit(scene.numerics.integrator);
  if (z == 0) return;  // contacts come and go: a growth rate says little about them
  const std::map<std::string, Real> masses = lightest_by_material(scene, samples);
  const auto limit = [&](const SpringConstants& constants, Real mass, std::string path) {
    if (constants.stiffness == 0) return;
    limits.push_back({std::move(path), "a contact of the lightest particles becomes unstable",
                      z * std::sqrt(mass / constants.stiffness)});
  };
  for (std::size_t i = 0; i < scene.interfaces.size(); ++i) {
    const InterfaceDescription& interface = scene.interfaces[i];
    Real inverse_mass = 0;
    bool used = true;
    for (const std::string& name : interface.materials) {
      if (name == kVatMaterial) continue;  // the walls do not yield
      const auto found = masses.find(name);
      used &= found != masses.end();
      if (found != masses.end()) inverse_mass += 1 / found->second;
    }
    if (used) limit(interface.constants, 1 / inverse_mass, "/interfaces/" + std::to_string(i));
  }
  for (std::size_t m = 0; m < scene.materials.size(); ++m) {
    const auto found = masses.find(scene.materials[m].name);
    if (found != masses.end() && scene.materials[m].self_contact) {
      limit(*scene.materials[m].self_contact, found->second / 2,
            "/materials/" + std::to_string(m) + "/self_contact");
    }
  }
}

void limit_liquids(const Scene& scene, std::vector<StepLimit>& limits) {
  const Real z = undamped_limit(scene.numerics.integrator);
  for (std::size_t b = 0; b < scene.bodies.size(); ++b) {
    if (scene.bodies[b].kind != BodyKind::liquid) continue;
    const Material& material = material_of(scene, scene.bodies[b]);
    const LiquidConstants& liquid = *material.liquid;
    const Real h = liquid.support_radius;
    if (liquid.stiffness > 0 && z > 0) {
      const Real sound = std::sqrt(liquid.stiffness);
      limits.push_back({body_path(b), "sound in the liquid becomes unstable",
                        kSoundLimit * h / sound * z / kVerletLimit});
    }
    if (liquid.viscosity > 0) {
      const Real viscosity = liquid.viscosity / material.density;
      limits.push_back(
          {body_path(b), "its viscosity becomes unstable", kViscousLimit * h * h / viscosity});
    }
  }
}

}  // namespace

Real undamped_limit(IntegratorId integrator) {
  switch (integrator) {
    case IntegratorId::symplectic_euler:
    case IntegratorId::velocity_verlet:
      return kVerletLimit;
    case IntegratorId::runge_kutta_4:
      return 2 * std::sqrt(Real{2});
    case IntegratorId::explicit_euler:
    case IntegratorId::heun:
      return 0;
  }
  VAT_CHECK(false && "not an integrator");
  return 0;
}

std::vector<StepLimit> find_step_limits(const Scene& scene,
                                        const std::vector<SampledBody>& samples) {
  std::vector<StepLimit> limits;
  limit_springs(scene, samples, limits);
  limit_contacts(scene, samples, limits);
  limit_liquids(scene, limits);
  return limits;
}

}  // namespace vat
