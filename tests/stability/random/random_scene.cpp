#include "tests/stability/random/random_scene.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <span>

#include "core/sampling/sampling.h"
#include "tests/stability/builders.h"
#include "tests/stability/random/random.h"

namespace vat::stability {
namespace {

/// Returns a random fraction of the critical damping of a mass.
Real damping(Random& random, Real stiffness, Real mass) {
  return random.chance(0.4) ? 0 : random.between(0, 0.5) * std::sqrt(stiffness * mass);
}

Material random_material(Random& random, std::string name, Real spacing) {
  Material material = test::make_material(std::move(name), random.scale(200, 3000));
  const Real mass = material.density * std::pow(spacing, 3);
  material.liquid = LiquidConstants{random.scale(20, 400),
                                    random.chance(0.3) ? 0 : random.scale(0.01, 5), 2 * spacing};
  const auto spring = [&](Real low, Real high) {
    const Real stiffness = random.scale(low, high) * mass;
    return SpringConstants{stiffness, damping(random, stiffness, mass)};
  };
  material.springs = LatticeSprings{spring(1e3, 1e5), spring(1e3, 1e5), {}};
  if (random.chance(0.3)) material.springs->bend = spring(1e2, 1e4);
  if (random.chance(0.5)) material.self_contact = spring(1e3, 1e4);
  return material;
}

MeshShape make_tetrahedron(Real size) {
  return {"tetrahedron",
          {{0, 0, 0}, {size, 0, 0}, {0, size, 0}, {0, 0, size}},
          {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}}};
}

Shape random_shape(Random& random, Real spacing) {
  switch (random.below(5)) {
    case 0:
      return SphereShape{Vec3::Zero(), random.between(1.1, 3.6) * spacing};
    case 1:
      return CylinderShape{Vec3::Zero(), Vec3(0, 0, 1) + random.vector(0.5),
                           random.between(1.2, 3.2) * spacing, random.between(2, 6) * spacing};
    case 2:
      return make_tetrahedron(random.between(4, 8) * spacing);
    case 3: {
      const int n = 1 + random.below(3);
      return ParticleShape{test::make_lattice(n, 2, 3, spacing), {}, {}, {}, {}};
    }
    default:
      return BoxShape{Vec3::Zero(), spacing * Vec3(1 + random.below(9), 1 + random.below(8),
                                                   1 + random.below(8))};
  }
}

BodyDescription random_body(Random& random, const Scene& scene, int number, Real spacing) {
  BodyDescription body;
  body.name = "body " + std::to_string(number);
  body.kind = kKinds[random.below(3)];
  body.material = scene
                      .materials[static_cast<std::size_t>(
                          random.below(static_cast<int>(scene.materials.size())))]
                      .name;
  body.shape = random_shape(random, spacing);
  body.spacing = spacing;
  body.velocity = random.vector(2);
  if (body.kind != BodyKind::liquid) {
    body.orientation = Quat(Eigen::AngleAxis<Real>(
        random.between(0, 3), (Vec3(0, 0, 0.1) + random.vector(1)).normalized()));
    body.angular_velocity = random.vector(5);
  }
  return body;
}

struct Sample {
  SampledBody body;
  bool placed = false;
};

bool is_apart(const SampledBody& a, const SampledBody& b) {
  for (std::size_t i = 0; i < a.positions.size(); ++i) {
    for (std::size_t j = 0; j < b.positions.size(); ++j) {
      if ((a.positions[i] - b.positions[j]).norm() < a.radii[i] + b.radii[j]) return false;
    }
  }
  return true;
}

bool is_inside(const SampledBody& body, const Vat& vat) {
  for (std::size_t i = 0; i < body.positions.size(); ++i) {
    const Vec3 gap = (body.positions[i] - vat.min).cwiseMin(vat.max - body.positions[i]);
    if (gap.minCoeff() < body.radii[i]) return false;
  }
  return true;
}

/// Places the body without overlaps. Returns false if no place was found.
bool place(Random& random, const Scene& scene, std::vector<SampledBody>& others,
           BodyDescription& body) {
  const auto material = std::ranges::find(scene.materials, body.material, &Material::name);
  for (int attempt = 0; attempt < 60; ++attempt) {
    for (int axis = 0; axis < 3; ++axis) {
      body.position[axis] = random.between(scene.vat->min[axis], scene.vat->max[axis]);
    }
    SampledBody sample = sample_body(body, *material);
    if (sample.positions.empty() || !is_inside(sample, *scene.vat)) continue;
    if (!std::ranges::all_of(others, [&](const auto& o) { return is_apart(sample, o); })) continue;
    others.push_back(std::move(sample));
    return true;
  }
  return false;
}

Real mass_of(const SampledBody& body) {
  Real mass = 0;
  for (const Real m : body.masses) mass += m;
  return mass;
}

/// Returns an interface of bodies whose lightest particle has this mass.
InterfaceConstants random_law(Random& random, Real stiffness, Real mass) {
  const Real rough = random.between(0.05, 1);
  const Real pick = random.between(0, 1);
  if (pick < 0.15) {
    return {.stiffness = stiffness,
            .law = InterfaceLaw::lennard_jones,
            .reach = random.between(1.3, 2.5)};
  }
  if (pick < 0.3) {
    return {
        .friction = rough, .law = InterfaceLaw::projection, .restitution = random.between(0, 0.8)};
  }
  if (pick < 0.45) {
    return {.stiffness = stiffness, .friction = rough, .restitution = random.between(0.1, 1)};
  }
  return {stiffness, damping(random, stiffness, mass), pick < 0.7 ? rough : 0};
}

/// Adds interfaces. A wall must stop the heaviest body at a single particle within half a radius.
/// The body may have fallen through the vat, with the initial speeds of body and vat.
void add_interfaces(Random& random, Scene& scene, std::span<const SampledBody> samples,
                    Real spacing) {
  Real heaviest = 0;
  Real lightest = 1e9;
  for (const SampledBody& sample : samples) {
    heaviest = std::max(heaviest, mass_of(sample));
    lightest = std::min(lightest, *std::ranges::min_element(sample.masses));
  }
  const Real height = (scene.vat->max - scene.vat->min).norm();
  Real speed2 = 2 * scene.gravity.norm() * height + 12 + 75 * 16 * spacing * spacing;
  if (scene.vat->motion) {
    const Real omega = 2 * std::numbers::pi / scene.vat->motion->period;
    speed2 += 4 * std::pow(scene.vat->motion->stroke / 2 * omega, 2);
  }
  const Real walls = 4 * heaviest * speed2 / std::pow(spacing / 2, 2);
  const bool damped_walls = random.chance(0.3);
  const Real roughness = random.chance(0.3) ? random.between(0.05, 1) : 0;
  for (const Material& material : scene.materials) {
    scene.interfaces.push_back(
        {{material.name, kVatMaterial},
         {walls, damped_walls ? 0.2 * std::sqrt(walls * lightest) : 0, roughness},
         {}});
  }
  const Real stiffness = random.scale(1e3, 1e5) * lightest;
  scene.default_interface = random_law(random, stiffness, lightest);
}

/// Selects an integrator that the scene permits, and a step of at most 0.4 of its limit.
void choose_numerics(Random& random, Scene& scene) {
  constexpr Real kMinAllowedStep = 2e-5;
  const Real pick = random.between(0, 1);
  scene.numerics.integrator = pick < 0.55   ? IntegratorId::velocity_verlet
                              : pick < 0.75 ? IntegratorId::symplectic_euler
                              : pick < 0.85 ? IntegratorId::runge_kutta_4
                              : pick < 0.93 ? IntegratorId::heun
                                            : IntegratorId::explicit_euler;
  const bool is_projected = scene.default_interface.law == InterfaceLaw::projection;
  if (least_step_limit(scene) < kMinAllowedStep || is_projected) {
    scene.numerics.integrator = IntegratorId::velocity_verlet;
  }
  const Real step = std::min(random.between(0.1, 0.4) * least_step_limit(scene), 1e-3);
  scene.numerics.step = step;
  scene.numerics.tick = 10 * step;
}

}  // namespace

Scene random_scene(std::uint64_t seed) {
  Random random(seed);
  const Real spacing = random.between(0.03, 0.08);
  Scene scene = test::make_scene(IntegratorId::velocity_verlet, 1e-3);
  scene.name = "random-" + std::to_string(seed);
  if (random.chance(0.85))
    scene.gravity = random.between(1, 15) * Vec3(0, 0, -1) + random.vector(5);
  const Vec3 side(random.between(8, 14), random.between(8, 14), random.between(8, 14));
  const Vec3 corner = random.vector(2);
  scene.vat = Vat{corner, corner + spacing * side, true, {}, {}};
  if (random.chance(0.4)) {
    scene.vat->motion = SlideMotion{Vec3(1, 0, 0) + random.vector(0.9), random.between(0.01, 0.1),
                                    random.between(0.2, 2)};
  }
  for (int m = 0; m < 3; ++m) {
    scene.materials.push_back(
        random_material(random, std::string(1, static_cast<char>('a' + m)), spacing));
  }
  std::vector<SampledBody> samples;
  const int wanted = 1 + random.below(6);
  for (int b = 0; b < wanted; ++b) {
    BodyDescription body = random_body(random, scene, b, spacing);
    if (place(random, scene, samples, body)) scene.bodies.push_back(body);
  }
  if (scene.bodies.empty()) return random_scene(seed + 0x9E3779B97F4A7C15U);
  add_interfaces(random, scene, samples, spacing);
  choose_numerics(random, scene);
  return scene;
}

}  // namespace vat::stability
