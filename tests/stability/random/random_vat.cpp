#include "tests/stability/random/random_vat.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/simulation/simulation.h"
#include "tests/stability/builders.h"
#include "tests/stability/random/random.h"

namespace vat::stability {
namespace {

constexpr Real kGravity = 9.81;

/// A pool that fills the lower `layers` layers of the vat's lattice.
BodyDescription make_random_pool(const Vec3& cells, int layers, Real spacing) {
  const Vec3 size(cells.x(), cells.y(), layers);
  BodyDescription pool{"pool", BodyKind::liquid, "water",
                       BoxShape{spacing * size / 2, spacing * size}, spacing};
  return pool;
}

/// A ball or block above the pool, away from the walls.
BodyDescription make_floater(Random& random, const Vec3& cells, int layers, Real spacing,
                             int number) {
  BodyDescription body{"floater " + std::to_string(number),
                       random.chance(0.5) ? BodyKind::rigid : BodyKind::deformable, "solid",
                       BoxShape{Vec3::Zero(), Vec3::Constant(2 * spacing)}, spacing};
  if (random.chance(0.5)) body.shape = SphereShape{Vec3::Zero(), 1.3 * spacing};
  // Placed along x, two cells from walls and from one another.
  body.position = spacing * Vec3(2.5 + 4 * number, random.between(2.5, cells.y() - 2.5),
                                 layers + random.between(1.5, 2));
  body.velocity = random.vector(std::sqrt(kGravity * spacing));
  return body;
}

/// Returns an oscillation with at most twice the acceleration of gravity.
SlideMotion make_motion(Random& random, Real width) {
  const Real stroke = random.scale(0.02, 0.5) * width;
  const Real acceleration = random.between(0.2, 2) * kGravity;
  return {random.chance(0.5) ? Vec3(Vec3::UnitX()) : Vec3(1, random.between(-1, 1), 0), stroke,
          2 * std::numbers::pi * std::sqrt(stroke / 2 / acceleration)};
}

Real greatest_slide(const Vat& vat) {
  return vat.motion ? std::numbers::pi * vat.motion->stroke / vat.motion->period : 0;
}

/// Sets materials, contacts that resist a fall through the vat, and steps.
void set_constants(Random& random, RandomVat& vat, Real spacing, PressureSolver solver) {
  Scene& scene = vat.scene;
  const Real height = scene.vat->max.z() - scene.vat->min.z();
  const Real speed = std::sqrt(2 * kGravity * height) + greatest_slide(*scene.vat);
  vat.sound = 10 * speed;
  const Real support = solver == PressureSolver::gas ? 2 : random.between(2, 3);
  const Real viscosity = random.chance(0.5) ? 0.001 : random.scale(0.01, 10);
  scene.materials = {test::make_liquid("water", random.scale(500, 2000),
                                       {vat.sound * vat.sound, viscosity, support * spacing}),
                     test::make_material("solid", random.scale(200, 3000))};
  const Real mass = scene.materials[1].density * std::pow(spacing, 3);
  const Real spring = random.scale(0.1, 1) * mass * std::pow(speed / spacing, 2) * 10;
  scene.materials[1].springs =
      LatticeSprings{SpringConstants{spring, 0}, SpringConstants{spring / 2, 0}, {}};
  const Real contact = 30 * mass * std::pow(speed / spacing, 2);
  scene.default_interface = {contact, 0.2 * std::sqrt(contact * mass)};
  scene.numerics.step = 1;
  take_stable_step(scene, solver == PressureSolver::gas ? 0.6 : 0.9);
}

Vec3 gravity_at(const RandomVat& vat, Real time) {
  const Real angle = vat.tilt_angle * std::sin(2 * std::numbers::pi * time / vat.tilt_period);
  return Eigen::AngleAxis<Real>(angle, vat.tilt_axis) * Vec3(0, 0, -kGravity);
}

std::string random_text_of(const GuardEvent& event, bool failed) {
  return std::string(to_string(event.cause)) + ", body " + std::to_string(event.body) + ", " +
         std::to_string(event.time) + (failed ? " s: the guard ended the run" : " s");
}

Real greatest_speed(const Simulation& simulation) {
  Real speed2 = 0;
  const BodyView body = simulation.bodies()[0];
  for (const Vec3& v : body.velocities) speed2 = std::max(speed2, v.squaredNorm());
  return std::sqrt(speed2);
}

}  // namespace

RandomVat random_vat(std::uint64_t seed, PressureSolver solver) {
  Random random(seed);
  RandomVat vat;
  const Real spacing = random.scale(0.005, 0.2);
  const Vec3 cells(8 + random.below(7), 8 + random.below(7), 9 + random.below(6));
  const bool is_incompressible = solver == PressureSolver::incompressible;
  vat.scene = test::make_scene(
      is_incompressible ? IntegratorId::symplectic_euler : IntegratorId::velocity_verlet, 1e-3);
  // The stable step depends on the pressure.
  if (is_incompressible) vat.scene.numerics.control = StepControl::adaptive;
  vat.scene.name = std::string(to_string(solver)) + "-vat-" + std::to_string(seed);
  vat.scene.pressure_solver = solver;
  vat.scene.vat = Vat{Vec3::Zero(), spacing * cells, random.chance(0.7), {}, {}};
  if (random.chance(0.7)) vat.scene.vat->motion = make_motion(random, spacing * cells.x());
  vat.tilt_axis = (Vec3(1, 0, 0) + random.vector(0.9)).normalized();
  vat.tilt_angle = random.chance(0.3) ? 0 : random.between(0, 0.7);
  vat.tilt_period = random.between(2, 20) * std::sqrt(spacing * cells.z() / kGravity);
  vat.scene.gravity = gravity_at(vat, 0);
  const int layers = 2 + random.below(4);
  vat.scene.bodies = {make_random_pool(cells, layers, spacing)};
  const int floaters = random.below(3);
  for (int n = 0; n < std::min(floaters, static_cast<int>(cells.x() / 4) - 1); ++n) {
    vat.scene.bodies.push_back(make_floater(random, cells, layers, spacing, n));
  }
  set_constants(random, vat, spacing, solver);
  return vat;
}

RandomVat with_sub_steps(RandomVat vat) {
  vat.scene.name += "-sub-steps";
  vat.scene.numerics.control = StepControl::local;
  LatticeSprings& springs = *vat.scene.materials[1].springs;
  springs.structural->stiffness *= 100;
  springs.shear->stiffness *= 100;
  return vat;
}

VatReport shake(const RandomVat& vat) {
  Simulation simulation = test::make_simulation(vat.scene);
  const Real height = vat.scene.vat->max.z() - vat.scene.vat->min.z();
  const Real until = 10 * std::sqrt(2 * height / kGravity);
  VatReport report;
  for (const BodyView& body : simulation.bodies()) report.particles += body.positions.size();
  const auto steps =
      static_cast<std::uint32_t>(std::lround(vat.scene.numerics.tick / simulation.step_size()));
  while (simulation.time() < until && report.fault.empty()) {
    const auto tilted = simulation.set_gravity(gravity_at(vat, simulation.time()));
    if (!tilted) report.fault = "gravity was refused";
    const AdvanceReport part = simulation.advance(steps);
    report.steps += part.steps;
    report.events += part.undone_steps;
    report.wall_stops += part.wall_stops;
    const std::size_t outside = simulation.diagnostics().particles_outside;
    report.outside = std::max(report.outside, outside);
    report.greatest_speed = std::max(report.greatest_speed, greatest_speed(simulation) / vat.sound);
    if (part.undone_steps > 0) report.fault = random_text_of(part.events.front(), part.failed);
    if (outside > 0) report.fault = "a particle left the vat";
    if (!(report.greatest_speed < 1)) report.fault = "liquid became as fast as sound";
  }
  report.hash = simulation.state_hash();
  return report;
}

}  // namespace vat::stability
