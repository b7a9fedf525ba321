#include "tests/bench/rounding/drift.h"

#include <algorithm>
#include <cmath>

#include "core/device/device_use.h"
#include "core/simulation/simulation.h"
#include "server/cli/simulate/simulate_run.h"
#include "tests/support/mixed_scenes.h"
#include "tests/support/totals.h"

namespace vat::bench {

namespace {

constexpr Real kDouble = 0x1p-53;
constexpr Real kSingle = 0x1p-24;

/// A drop that a central field deforms periodically, about the origin.
Scene make_drop() {
  constexpr Real kSpacing = 0.05;
  Scene scene = test::make_scene(IntegratorId::velocity_verlet, 1e-3);
  scene.pressure_solver = PressureSolver::tait;
  scene.pair_precision = PairPrecision::single_precision;
  scene.central_field = CentralField{Vec3::Zero(), 1};
  scene.materials = {test::make_liquid("water", 1000, {25, 0, 2 * kSpacing})};
  scene.bodies = {BodyDescription{"drop", BodyKind::liquid, "water",
                                  SphereShape{Vec3::Zero(), 3 * kSpacing}, kSpacing}};
  scene.bodies[0].velocity_field = VectorField{};
  scene.bodies[0].velocity_field->gradient.diagonal() = Vec3(0.5, -0.25, -0.25);
  scene.bodies[0].velocity_field->gradient(0, 1) = 0.3;
  return scene;
}

Scene make_block_of(BodyKind kind) {
  Scene scene = test::make_scene(IntegratorId::velocity_verlet, 1e-3,
                                 {test::make_material("a"), test::make_material("b")});
  scene.bodies = {test::make_block("block", kind, "a", 3, Vec3::Zero(), {0, 0, 0})};
  return scene;
}

/// An elastic block of 27 particles that turns and oscillates.
Scene make_elastic_block() {
  Scene scene = make_block_of(BodyKind::deformable);
  for (SpringDescription& spring : scene.bodies[0].springs) spring.constants.damping = 0;
  scene.bodies[0].velocity_field = VectorField{};
  scene.bodies[0].velocity_field->gradient << 0.5, 0.8, 0.1, -0.7, -0.3, 0.2, 0.3, -0.4, 0.1;
  return scene;
}

/// A rigid body with three different moments of inertia that tumbles.
Scene make_tumbling_body() {
  Scene scene = make_block_of(BodyKind::rigid);
  auto& shape = std::get<ParticleShape>(scene.bodies[0].shape);
  for (Vec3& x : shape.positions) x = x.cwiseProduct(Vec3(1, 1.5, 2.2));
  scene.bodies[0].angular_velocity = {0.1, 3, 0.2};
  // The method changes the energy by about (3 rad/s dt)^4 = 10^-14 at most.
  scene.numerics.step = scene.numerics.tick = 1e-4;
  return scene;
}

std::vector<Vec3> velocities_of(const Simulation& simulation) {
  std::vector<Vec3> velocities;
  for (const BodyView& body : simulation.bodies()) {
    velocities.insert(velocities.end(), body.velocities.begin(), body.velocities.end());
  }
  return velocities;
}

/// The sum of m |v - v'|.
Real change_since(const std::vector<Vec3>& before, const Simulation& simulation) {
  Real sum = 0;
  std::size_t n = 0;
  for (const BodyView& body : simulation.bodies()) {
    for (std::size_t i = 0; i < body.masses.size(); ++i) {
      sum += body.masses[i] * (body.velocities[i] - before[n++]).norm();
    }
  }
  return sum;
}

Status advance(Simulation& simulation, bool has_device, std::uint32_t steps) {
  const AdvanceReport report = simulation.advance(steps);
  if (report.device_error) return *report.device_error;
  if (report.failed) return describe(report.events.back(), simulation);
  if (has_device && report.device_steps != steps) {
    return Error{"device_failed", "/device", "the CPU has taken steps"};
  }
  return {};
}

}  // namespace

std::vector<ConservingScene> conserving_scenes() {
  return {{"drop", make_drop(), kSingle},
          {"elastic block", make_elastic_block(), kDouble},
          {"tumbling body", make_tumbling_body(), kDouble, true}};
}

Result<Drift> measure_drift(const ConservingScene& one, const std::optional<DeviceChoice>& device,
                            std::uint64_t steps) {
  VAT_CHECK(steps > 0 && steps % kDriftInterval == 0);
  Result<Simulation> created = Simulation::create(one.scene);
  if (!created) return created.errors();
  Simulation& simulation = created.value();
  if (device) {
    if (Status used = use_device(*device, simulation); !used) return used.errors();
  }
  const Diagnostics first = simulation.diagnostics();
  const test::Totals start = test::totals_of(first);
  const test::Motion motion = test::motion_of(simulation);
  VAT_CHECK(motion.momentum > 0 && motion.angular_momentum > 0);
  Drift drift;
  for (std::uint64_t done = 0; done < steps; done += kDriftInterval) {
    const std::vector<Vec3> before = velocities_of(simulation);
    if (Status step = advance(simulation, device.has_value(), 1); !step) return step.errors();
    const Real samples = static_cast<Real>(steps / kDriftInterval);
    drift.change += change_since(before, simulation) / (motion.momentum * samples);
    Status rest = advance(simulation, device.has_value(), kDriftInterval - 1);
    if (!rest) return rest.errors();
    const Diagnostics diagnostics = simulation.diagnostics();
    const test::Totals now = test::totals_of(diagnostics);
    drift.energy =
        std::max(drift.energy, std::abs(diagnostics.kinetic_energy / first.kinetic_energy - 1));
    drift.momentum =
        std::max(drift.momentum, (now.momentum - start.momentum).norm() / motion.momentum);
    drift.angular_momentum =
        std::max(drift.angular_momentum,
                 (now.angular_momentum - start.angular_momentum).norm() / motion.angular_momentum);
  }
  return drift;
}

Real drift_bound(const ConservingScene& one, const Drift& drift, std::uint64_t steps) {
  return static_cast<Real>(steps) * kOperations * (kDouble + one.precision * drift.change);
}

}  // namespace vat::bench
