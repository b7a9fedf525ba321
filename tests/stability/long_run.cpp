#include "tests/stability/long_run.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <utility>

#include "tests/stability/builders.h"
#include "tests/support/totals.h"

namespace vat::stability {
namespace {

/// Returns the bound of sums of N terms with random signs, with half a unit of round-off in each of
/// some dozen operations per step. The worst case would be linear.
Real round_off(std::uint64_t steps) {
  return 12 * 1.2e-16 * std::sqrt(static_cast<Real>(steps)) + 1e-15;
}
Real energy_of(const Diagnostics& now) {
  return now.kinetic_energy + now.elastic_energy + now.contact_energy + now.gravitational_energy;
}

/// Energies during the run: range and trend.
struct EnergySeries {
  std::vector<Real> values;

  Real mean(std::size_t begin, std::size_t end) const {
    Real sum = 0;
    for (std::size_t i = begin; i < end; ++i) sum += values[i];
    return sum / static_cast<Real>(end - begin);
  }
  Real greatest_change() const {
    Real greatest = 0;
    for (const Real value : values) {
      greatest = std::max(greatest, std::abs(value / values.front() - 1));
    }
    return greatest;
  }
  /// Returns the difference between the means of the first and the last half.
  Real drift() const {
    const std::size_t half = values.size() / 2;
    return std::abs(mean(half, values.size()) - mean(0, half)) / std::abs(values.front());
  }
};

using Watch = std::function<void(const Simulation&, const Diagnostics&)>;

struct Run {
  std::uint64_t steps = 0;
  std::uint64_t undone = 0;
  std::uint64_t hash = 0;
};

/// Advances the simulation and calls `watch` a thousand times. The interval is not a multiple of
/// any period.
Run watch_run(const Scene& scene, std::uint64_t steps, const Watch& watch) {
  constexpr std::uint64_t kLooks = 1000;
  Simulation simulation = test::make_simulation(scene);
  Run run;
  watch(simulation, simulation.diagnostics());
  while (run.steps < steps) {
    const auto stride = static_cast<std::uint32_t>(std::min(steps / kLooks + 1, steps - run.steps));
    run.undone += simulation.advance(stride).undone_steps;
    run.steps += stride;
    watch(simulation, simulation.diagnostics());
  }
  run.hash = simulation.state_hash();
  return run;
}

LongRunRow make_row(const Run& run, std::string scene, std::string quantity, Real value, Real bound,
                    std::string reason) {
  return {std::move(scene),  std::move(quantity), value,      bound,
          std::move(reason), run.steps,           run.undone, run.hash};
}

/// The case DEF-1 of the validation: omega dt = 0.1.
std::vector<LongRunRow> run_oscillator(std::uint64_t steps) {
  Scene scene = make_scene();
  scene.gravity = Vec3::Zero();
  scene.numerics.step = scene.numerics.tick = 0.01;
  scene.bodies = {make_spring_pair("pair", 1.2, 1, {100, 0}, {1, 1})};
  std::get<ParticleShape>(scene.bodies[0].shape).fixed = {0};
  constexpr Real kPhase = 0.1;
  EnergySeries energy;
  Real amplitude = 0;
  const Run run =
      watch_run(scene, steps, [&](const Simulation& simulation, const Diagnostics& now) {
        energy.values.push_back(energy_of(now));
        amplitude =
            std::max(amplitude, std::abs(test::position_of(simulation, 0, 1).x() - 1) / 0.2);
      });
  const Real swing = kPhase * kPhase / 4;
  return {make_row(run, "oscillator", "energy, greatest change", energy.greatest_change(),
                   1.01 * swing, "(omega dt)^2 / 4, of velocity Verlet"),
          // The mean of 500 phases of such an oscillation is known to 1 / sqrt(500) only.
          make_row(run, "oscillator", "energy, drift", energy.drift(), swing / std::sqrt(250.0),
                   "no trend: what the mean of 500 looks leaves"),
          make_row(run, "oscillator", "amplitude", amplitude - 1, round_off(steps) + 1e-12,
                   "starts at a turning point of the discrete motion")};
}

/// The case DEF-6b: eight rotating masses, joined by all 28 springs.
Scene make_spring_cube() {
  Scene scene = make_scene();
  scene.gravity = Vec3::Zero();
  scene.materials[2].self_contact.reset();
  scene.numerics.step = scene.numerics.tick = 1e-2;
  const std::vector<Vec3> corners = test::make_lattice(2, 2, 2, 1);
  scene.bodies = {test::make_body("cube", BodyKind::deformable, "rubber",
                                  test::make_particles(corners, 0.25), kSpacing / 2)};
  scene.bodies[0].springs = test::join_near(corners, 2, {50, 0});
  scene.bodies[0].velocity = {0.3, -0.2, 0.1};
  scene.bodies[0].angular_velocity = {1, 2, 3};
  return scene;
}

std::vector<LongRunRow> run_spring_cube(std::uint64_t steps) {
  const Scene scene = make_spring_cube();
  EnergySeries energy;
  Vec3 momentum;
  Vec3 angular_momentum;
  Real momentum_error = 0;
  Real angular_error = 0;
  Real elastic = 0;
  const Run run = watch_run(scene, steps, [&](const Simulation&, const Diagnostics& now) {
    if (energy.values.empty()) {
      momentum = test::totals_of(now).momentum;
      angular_momentum = test::totals_of(now).angular_momentum;
    }
    energy.values.push_back(energy_of(now));
    elastic = std::max(elastic, now.elastic_energy);
    momentum_error = std::max(momentum_error, (test::totals_of(now).momentum - momentum).norm());
    // Angular momentum is about the origin. The centre of mass moves away, and the terms of L grow
    // with its distance.
    const Real size = 1 + now.bodies[0].center_of_mass.norm();
    angular_error = std::max(
        angular_error, (test::totals_of(now).angular_momentum - angular_momentum).norm() / size);
  });
  // Modified energy: z^2 (K / 6 + U / 12) at both ends, for the energy that moves in the springs.
  const Real phase = 2 * scene.numerics.step / least_step_limit(scene);
  const Real in_springs = 2 * elastic / energy.values.front();
  const Real bound = 2 * phase * phase / 6 * std::max(in_springs, 0.0) + phase * phase / 6;
  return {make_row(run, "spring cube", "energy, greatest change", energy.greatest_change(), bound,
                   "(omega dt)^2 / 6 of the energy, of velocity Verlet"),
          make_row(run, "spring cube", "energy, drift", energy.drift(), bound / std::sqrt(250.0),
                   "no trend: what the mean of 500 looks leaves"),
          make_row(run, "spring cube", "momentum / (kg m/s)", momentum_error,
                   8 * 0.6 * round_off(steps), "round-off"),
          make_row(run, "spring cube", "angular momentum / (kg m^2/s)", angular_error,
                   8 * 5 * round_off(steps), "round-off, over 1 m + distance")};
}

/// The case RIG-1: I = (2, 3, 4), omega = (1, 0, 1).
std::vector<LongRunRow> run_top(std::uint64_t steps) {
  Scene scene = make_scene();
  scene.gravity = Vec3::Zero();
  scene.numerics.step = scene.numerics.tick = 0.02;
  const Real x = std::sqrt(2.5);
  const Real y = std::sqrt(1.5);
  const Real z = std::sqrt(0.5);
  constexpr Real kBodyRadius = 1e-5;  // the particles' own inertia is 1e-10 of the body's
  scene.bodies = {test::make_body(
      "top", BodyKind::rigid, "wood",
      test::make_particles({{x, 0, 0}, {-x, 0, 0}, {0, y, 0}, {0, -y, 0}, {0, 0, z}, {0, 0, -z}},
                           0.5),
      kBodyRadius)};
  scene.bodies[0].angular_velocity = {1, 0, 1};
  EnergySeries energy;
  Vec3 angular_momentum;
  Real error = 0;
  const Run run = watch_run(scene, steps, [&](const Simulation&, const Diagnostics& now) {
    if (energy.values.empty()) angular_momentum = test::totals_of(now).angular_momentum;
    energy.values.push_back(energy_of(now));
    error = std::max(error, (test::totals_of(now).angular_momentum - angular_momentum).norm());
  });
  // A symmetric splitting of fourth order in dt times the rotation rate |L| / I_min, with a
  // constant of order one. Angular momentum is part of the state, and no torque acts.
  const Real phase = 0.02 * std::sqrt(20.0) / 2;
  return {
      make_row(run, "top", "energy, greatest change", energy.greatest_change(),
               std::pow(phase, 4) + round_off(steps), "(dt |L| / I_min)^4, bounded"),
      make_row(run, "top", "angular momentum / (kg m^2/s)", error, 0, "constant by construction")};
}

/// The case RIG-6: a stack of five bodies of 2 kg.
std::vector<LongRunRow> run_stack(std::uint64_t steps) {
  constexpr Real kStiffness = 5e4;
  constexpr Real kMass = 2;
  constexpr Real kBallRadius = 0.05;
  constexpr Real kGravity = 9.81;
  Scene scene = make_tank();
  scene.default_interface = {kStiffness, 0.1 * std::sqrt(kStiffness * kMass)};
  for (auto& interface : scene.interfaces) interface.constants = scene.default_interface;
  std::vector<Real> rest;
  Real height = 0;
  for (int b = 0; b < 5; ++b) {
    const Real overlap = (5 - b) * kMass * kGravity / kStiffness;
    height += (b == 0 ? kBallRadius : 2 * kBallRadius) - overlap;
    rest.push_back(height);
    scene.bodies.push_back(make_particle("ball " + std::to_string(b), BodyKind::rigid,
                                         {0.5, 0.5, height + 1e-3}, kMass, kBallRadius));
  }
  Real creep = 0;
  Real sideways = 0;
  Real kinetic = 0;
  const Real settled = 0.9 * static_cast<Real>(steps) * scene.numerics.step;
  const Run run =
      watch_run(scene, steps, [&](const Simulation& simulation, const Diagnostics& now) {
        if (simulation.time() < settled) return;
        kinetic = std::max(kinetic, now.kinetic_energy);
        for (std::size_t b = 0; b < 5; ++b) {
          const Vec3 position = test::position_of(simulation, b);
          creep = std::max(creep, std::abs(position.z() - rest[b]));
          sideways = std::max(sideways, std::hypot(position.x() - 0.5, position.y() - 0.5));
        }
      });
  const Real overlap = kMass * kGravity / kStiffness;
  return {make_row(run, "stack", "distance from rest / m", creep, 1e-6,
                   "statics; the dossier allows 1e-6 m of creep"),
          make_row(run, "stack", "sideways / m", sideways, 0, "nothing acts sideways"),
          make_row(run, "stack", "kinetic energy / m g delta",
                   kinetic / (kMass * kGravity * overlap), 1e-6, "the dossier's measure of rest")};
}

/// An undisturbed pool, and its mean kinetic energies in the last quarters of the run.
struct Pool {
  Run run;
  Real third_quarter = 0;  ///< relative to m g H
  Real last_quarter = 0;   ///< relative to m g H
  std::size_t outside = 0;
};

Pool run_pool_of(Real viscosity, std::uint64_t steps) {
  Scene scene = make_tank();
  constexpr int kPoolEdge = 5;
  const Real width = kPoolEdge * kSpacing;
  scene.vat->max = {width, width, 1};
  scene.materials[0].liquid->viscosity = viscosity;
  scene.numerics.step = 2e-3;
  scene.bodies = {make_block("pool", BodyKind::liquid, kPoolEdge,
                             {width / 2, width / 2, width / 2 + kSpacing / 4})};
  EnergySeries kinetic;
  Pool pool;
  pool.run = watch_run(scene, steps, [&](const Simulation&, const Diagnostics& now) {
    kinetic.values.push_back(now.kinetic_energy);
    pool.outside = std::max(pool.outside, now.particles_outside);
  });
  const Real scale = kPoolEdge * kPoolEdge * kPoolEdge * 0.125 * 9.81 * width;
  const std::size_t count = kinetic.values.size();
  pool.third_quarter = kinetic.mean(count / 2, 3 * count / 4) / scale;
  pool.last_quarter = kinetic.mean(3 * count / 4, count) / scale;
  return pool;
}

/// The case LIQ-3. Density and pressure have different kernels, so pressure forces do work on
/// closed paths. A liquid comes to rest if viscosity dissipates more than that.
std::vector<LongRunRow> run_pool(std::uint64_t steps) {
  const Pool pool = run_pool_of(20, steps);
  return {make_row(pool.run, "pool", "kinetic energy / m g H", pool.last_quarter, 1e-5,
                   "the dossier's plateau"),
          make_row(pool.run, "pool", "particles outside", static_cast<Real>(pool.outside), 0,
                   "walls hold")};
}

/// A liquid with less viscosity remains in motion, at a level that must not rise.
std::vector<LongRunRow> run_thin_pool(std::uint64_t steps) {
  const Pool pool = run_pool_of(1, steps);
  return {make_row(pool.run, "thin pool", "kinetic energy, growth by a quarter of the run",
                   pool.last_quarter / pool.third_quarter - 1, 0.1,
                   "stationary: what means of 250 looks leave"),
          make_row(pool.run, "thin pool", "kinetic energy / m c^2",
                   pool.last_quarter * 9.81 * 0.25 / 100, 0.5, "slower than sound"),
          make_row(pool.run, "thin pool", "particles outside", static_cast<Real>(pool.outside), 0,
                   "walls hold")};
}

using Runner = std::vector<LongRunRow> (*)(std::uint64_t);
constexpr std::pair<const char*, Runner> kRuns[] = {{"oscillator", run_oscillator},
                                                    {"spring-cube", run_spring_cube},
                                                    {"top", run_top},
                                                    {"stack", run_stack},
                                                    {"pool", run_pool},
                                                    {"thin-pool", run_thin_pool}};

}  // namespace

std::vector<std::string> long_run_names() {
  std::vector<std::string> names;
  for (const auto& [name, runner] : kRuns) names.emplace_back(name);
  return names;
}

std::vector<LongRunRow> run_long(const std::string& name, std::uint64_t steps) {
  for (const auto& [known, runner] : kRuns) {
    if (known == name) return runner(steps);
  }
  return {};
}

}  // namespace vat::stability
