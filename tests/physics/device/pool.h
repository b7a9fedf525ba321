#pragma once

#include <cmath>

#include "tests/physics/device/on_device.h"
#include "tests/support/mixed_scenes.h"
#include "tests/support/momentum_watch.h"
#include "tests/support/scenes.h"

// A pool with solids, for solvers whose solids move in liquids.

namespace vat::test {

inline constexpr Real kPoolSpacing = 0.02;

inline BodyDescription make_solid(const char* name, BodyKind kind, const char* material,
                                  const Shape& shape, const Vec3& position,
                                  const Vec3& velocity = Vec3::Zero()) {
  BodyDescription body{name, kind, material, shape, kPoolSpacing};
  body.position = position;
  body.velocity = velocity;
  return body;
}

/// Returns an integrator that the solver permits.
inline IntegratorId integrator_for(PressureSolver solver) {
  return solver == PressureSolver::incompressible ? IntegratorId::symplectic_euler
                                                  : IntegratorId::velocity_verlet;
}

/// A collapsing column of water, and a ball that falls on it, near a wall of the vat.
inline Scene make_pool(PressureSolver solver = PressureSolver::tait) {
  Scene scene = make_scene(integrator_for(solver), 1e-3);
  scene.pressure_solver = solver;
  scene.gravity = {0, 0, -9.81};
  scene.materials = {make_liquid("water", 1000, {400, 0.01, 2 * kPoolSpacing}),
                     make_material("wood", 500)};
  if (solver == PressureSolver::tait) scene.materials[0].liquid->artificial_viscosity = 0.1;
  scene.default_interface = {1000, 0.2};
  scene.vat = Vat{{0, 0, 0}, {0.3, 0.12, 0.4}, false, {}};
  scene.bodies = {BodyDescription{"column", BodyKind::liquid, "water",
                                  BoxShape{{0.08, 0.06, 0.08}, {0.16, 0.12, 0.16}}, kPoolSpacing},
                  make_solid("ball", BodyKind::rigid, "wood", SphereShape{Vec3::Zero(), 0.03},
                             {0.035, 0.06, 0.2}, {-0.2, 0, -1})};
  scene.bodies[1].angular_velocity = {2, 5, -1};
  return scene;
}

/// Adds a plate beside the column, which moves towards it.
inline void add_piston(Scene& scene) {
  scene.bodies.push_back(make_solid("piston", BodyKind::rigid, "wood",
                                    BoxShape{Vec3::Zero(), {0.04, 0.12, 0.2}}, {0.19, 0.06, 0.1}));
  scene.bodies.back().motion = SlideMotion{{-1, 0, 0.1}, 0.04, 0.2};
}

/// Adds a piston that also rotates.
inline void add_rotating_piston(Scene& scene) {
  add_piston(scene);
  scene.bodies.back().angular_velocity = {0, 4, 1};
}

/// Replaces the ball by a fixed ball that moves through the column with these velocities.
inline void add_fixed_mover(Scene& scene, const Vec3& velocity, const Vec3& angular_velocity) {
  scene.bodies[1].position = {0.19, 0.06, 0.08};
  scene.bodies[1].velocity = velocity;
  scene.bodies[1].angular_velocity = angular_velocity;
  scene.bodies[1].fixed = true;
}

/// Adds a ball that collides with the first one.
inline void add_other_ball(Scene& scene) {
  scene.bodies.push_back(make_solid("other ball", BodyKind::rigid, "wood",
                                    SphereShape{Vec3::Zero(), 0.03}, {0.1, 0.06, 0.2},
                                    {-1.5, 0, -1}));
}

/// Adds a block of jelly that falls into the water beside the ball.
inline void add_wet_jelly(Scene& scene) {
  Material jelly = make_material("jelly", 500);
  jelly.springs = LatticeSprings{SpringConstants{200, 0.05}, SpringConstants{100, 0.02},
                                 SpringConstants{50, 0}};
  jelly.self_contact = SpringConstants{500, 0.1};
  scene.materials.push_back(jelly);
  scene.bodies.push_back(make_solid("jelly", BodyKind::deformable, "jelly",
                                    BoxShape{Vec3::Zero(), {0.08, 0.06, 0.06}}, {0.115, 0.06, 0.2},
                                    {-0.5, 0.2, -1}));
}

inline void set_plane(Scene& scene) {
  scene.dimensions = 2;
  std::get<BoxShape>(scene.bodies[0].shape).center.y() = 0;
  for (std::size_t b = 1; b < scene.bodies.size(); ++b) {
    scene.bodies[b].position.y() = 0;
    scene.bodies[b].velocity.y() = 0;
    scene.bodies[b].angular_velocity = {0, scene.bodies[b].angular_velocity.y(), 0};
  }
  scene.vat->min.y() = -1;
  scene.vat->max.y() = 1;
}

/// A pool in two dimensions, which settles until 0.6 s around a flat box of this density ratio at
/// its draft.
inline Scene make_floating_box(PressureSolver solver, Real step, Real ratio) {
  constexpr Real kLattice = 0.025;
  constexpr Real kDepth = 12 * kLattice;
  constexpr Real kWidth = 28 * kLattice;
  const Vec3 half(5 * kLattice, 1, 3 * kLattice);
  Scene scene = make_scene(integrator_for(solver), step);
  scene.dimensions = 2;
  scene.pressure_solver = solver;
  scene.gravity = {0, 0, -9.81};
  scene.materials = {make_liquid("water", 1000, {343, 10, 3 * kLattice}),
                     make_material("wood", 1000 * ratio)};
  scene.settling = Settling{53, 0.6};
  scene.vat = Vat{{0, -1, 0}, {kWidth, 1, 2}, false, {}};
  const Vec3 center(kWidth / 2, 0, kDepth + 2 * half.z() * (0.5 - ratio));
  std::vector<Vec3> water;
  for (const Vec3& point : make_lattice(28, 1, 12, kLattice)) {
    const Vec3 at = point + Vec3(kWidth / 2, 0, kDepth / 2);
    const Vec3 beyond = (at - center).cwiseAbs() - half - Vec3::Constant(kLattice / 2);
    if (beyond.maxCoeff() > 0) water.push_back(at);
  }
  scene.bodies = {
      make_body("water", BodyKind::liquid, "water",
                make_particles(water, 1000 * kLattice * kLattice), kLattice / 2),
      make_solid("box", BodyKind::rigid, "wood", BoxShape{Vec3::Zero(), 2 * half}, center)};
  scene.bodies[1].spacing = kLattice;
  return scene;
}

/// Returns the mean draft of the box of make_floating_box() from 1 to 1.4 s / its height.
inline Real find_draft(const Scene& scene) {
  constexpr int kSamples = 20;
  constexpr Real kTimeOfSample = 0.02;
  const auto steps = static_cast<std::uint32_t>(std::llround(kTimeOfSample / scene.numerics.tick));
  const Real height = std::get<BoxShape>(scene.bodies[1].shape).size.z();
  Simulation device = make_on_device(scene);
  EXPECT_EQ(device.advance(50 * steps).device_steps, 50 * steps);
  Real sum = 0;
  for (int n = 0; n < kSamples; ++n) {
    EXPECT_EQ(device.advance(steps).device_steps, steps);
    const Diagnostics now = device.diagnostics();
    const Real level = (now.bodies[0].mass + now.bodies[1].mass) / 1000 / scene.vat->max.x();
    sum += (level - now.bodies[1].center_of_mass.z() + height / 2) / height;
  }
  return sum / kSamples;
}

/// The rounding error of a momentum relative to the sum over all particles. Sums of forces in
/// single precision have up to 64 terms with one rounding error each.
inline constexpr Real kRoundingOfMomentum = 64 * 0x1p-23;

/// A block of liquid that meets a solid one, without gravity and vat.
inline Scene make_splash(PressureSolver solver, BodyKind kind) {
  Scene scene = make_collision(BodyKind::liquid, kind, integrator_for(solver), 1e-3);
  scene.pressure_solver = solver;
  return scene;
}

/// Expects that the device conserves momentum in make_splash(). Returns the simulation at the end.
inline Simulation expect_momentum_of_splash(PressureSolver solver, BodyKind kind) {
  Simulation device = make_on_device(make_splash(solver, kind));
  const MomentumWatch watch(device);
  const Vec3 start = device.diagnostics().bodies[0].linear_momentum;
  EXPECT_EQ(device.advance(100).device_steps, 100U);
  const Vec3 end = device.diagnostics().bodies[0].linear_momentum;
  EXPECT_GT((end - start).norm(), 0.1 * start.norm());
  watch.expect_momentum(kRoundingOfMomentum);
  return device;
}

}  // namespace vat::test
