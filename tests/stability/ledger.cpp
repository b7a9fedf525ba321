#include "tests/stability/ledger.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>

#include "tests/stability/builders.h"
#include "tests/support/totals.h"

namespace vat::stability {
namespace {

const Material& find_material(const Scene& scene, std::string_view name) {
  return *std::ranges::find(scene.materials, name, &Material::name);
}

InterfaceConstants wall_constants(const Scene& scene, std::string_view material) {
  for (const InterfaceDescription& interface : scene.interfaces) {
    if (interface.materials[0] == material && interface.materials[1] == kVatMaterial) {
      return interface.constants;
    }
  }
  return scene.default_interface;
}

struct VatPose {
  Vec3 offset = Vec3::Zero();
  Vec3 velocity = Vec3::Zero();
};

VatPose vat_pose(const Vat& vat, Real time) {
  if (!vat.motion) return {};
  const Real omega = 2 * std::numbers::pi / vat.motion->period;
  const Vec3 half = vat.motion->stroke / 2 * vat.motion->axis.normalized();
  return {half * (1 - std::cos(omega * time)), half * omega * std::sin(omega * time)};
}

/// A particle in contact with a wall. If it is rigid, its body rotates.
struct Touching {
  Real mass;
  Real radius;
  Vec3 position;
  Vec3 velocity;
  std::optional<Vec3> spin;
};

/// Returns the friction of a wall that exerts `push` (signed) along the axis at `distance` from the
/// centre. Friction is Coulomb's, but proportional to the slip at small slips.
Vec3 friction(const InterfaceConstants& law, const Touching& particle, const VatPose& pose,
              int axis, Real push, Real distance) {
  Vec3 slip = particle.velocity - pose.velocity;
  if (particle.spin) {
    slip += particle.spin->cross(Vec3(std::copysign(distance, -push) * Vec3::Unit(axis)));
  }
  slip[axis] = 0;
  const Real most = law.friction * std::abs(push);
  const Vec3 slow = std::sqrt(law.stiffness * particle.mass) * slip;
  return slow.norm() > most ? Vec3(-most * slip.normalized()) : Vec3(-slow);
}

/// Returns the force of the six walls of a closed vat on one particle.
Vec3 wall_force(const Vat& vat, const VatPose& pose, const InterfaceConstants& law,
                const Touching& particle) {
  Vec3 force = Vec3::Zero();
  for (int axis = 0; axis < 3; ++axis) {
    const Real x = particle.position[axis] - pose.offset[axis];
    const Real v = particle.velocity[axis] - pose.velocity[axis];
    const auto push = [&](Real side, Real distance) {
      const Real overlap = particle.radius - distance;
      const Real strength = law.stiffness * overlap - side * law.damping * v;
      if (overlap <= 0 || strength <= 0) return;
      force[axis] += side * strength;
      if (law.friction > 0) force += friction(law, particle, pose, axis, side * strength, distance);
    };
    push(1, x - vat.min[axis]);
    push(-1, vat.max[axis] - x);
  }
  return force;
}

Real pressure_energy(const Scene& scene, const Diagnostics& now) {
  Real energy = 0;
  for (std::size_t b = 0; b < scene.bodies.size(); ++b) {
    if (scene.bodies[b].kind != BodyKind::liquid) continue;
    const Material& material = find_material(scene, scene.bodies[b].material);
    energy += now.bodies[b].mass * material.liquid->stiffness * now.max_density_error *
              now.max_density_error / 2;
  }
  return energy;
}

}  // namespace

Ledger::Outside Ledger::outside(const Simulation& simulation) {
  const Scene& scene = simulation.scene();
  const VatPose pose = scene.vat ? vat_pose(*scene.vat, simulation.time()) : VatPose{};
  Outside sum{Vec3::Zero(), 0, 0};
  for (const BodyView& body : simulation.bodies()) {
    const InterfaceConstants law = wall_constants(scene, body.material);
    for (std::size_t i = 0; i < body.positions.size(); ++i) {
      sum.force += body.masses[i] * scene.gravity;
      if (!scene.vat) continue;
      Touching particle{body.masses[i], body.radii[i], body.positions[i], body.velocities[i], {}};
      if (body.pose) particle.spin = body.pose->angular_velocity;
      const Vec3 force = wall_force(*scene.vat, pose, law, particle);
      sum.force += force;
      if (force != Vec3::Zero()) {
        const Real unit = std::numeric_limits<Real>::epsilon() / 2 * body.positions[i].norm();
        sum.rounding += law.stiffness * unit;
      }
      sum.power += force.dot(pose.velocity);
    }
  }
  return sum;
}

Real Ledger::mechanical(const Diagnostics& now) {
  return now.kinetic_energy + now.gravitational_energy + now.elastic_energy + now.contact_energy;
}

bool Ledger::closes(const Scene& scene) {
  if (scene.numerics.integrator != IntegratorId::velocity_verlet) return false;
  if (!scene.vat) return true;
  return scene.numerics.control != StepControl::local &&
         std::ranges::all_of(scene.materials, [&](const Material& material) {
           const InterfaceConstants law = wall_constants(scene, material.name);
           return law.damping == 0 && law.friction == 0 && !law.restitution;
         });
}

Ledger::Ledger(const Simulation& simulation)
    : scene_(simulation.scene()), last_(outside(simulation)) {
  const Diagnostics start = simulation.diagnostics();
  momentum_ = test::totals_of(start).momentum;
  energy_ = mechanical(start);
  Scene verlet = scene_;
  verlet.numerics.integrator = IntegratorId::velocity_verlet;
  phase_ = 2 * scene_.numerics.step / least_step_limit(verlet);
  add_step(simulation, start);
}

void Ledger::add_step(const Simulation& simulation, const Diagnostics& now) {
  const Outside next = outside(simulation);
  const Real dt = now.bodies.empty() ? 0 : simulation.step_size();
  const bool is_start = moved_ == 0;
  if (!is_start) {
    momentum_ += dt / 2 * (last_.force + next.force);
    moved_ += dt / 2 * (last_.force + next.force).norm();
    energy_ += dt / 2 * (last_.power + next.power);
    rounding_ += dt * next.rounding;
  }
  last_ = next;
  const Real motion = test::motion_of(simulation).momentum;
  if (is_start) moved_ = motion + 1e-300;
  momentum_error_ = std::max(
      momentum_error_, (test::totals_of(now).momentum - momentum_).norm() / (moved_ + motion));
  energy_excess_ = std::max(energy_excess_, mechanical(now) - energy_);
  energy_scale_ =
      std::max(energy_scale_, now.kinetic_energy + now.elastic_energy + now.contact_energy);
  liquid_energy_ = std::max(liquid_energy_, pressure_energy(scene_, now));
}

Real Ledger::momentum_bound() const {
  constexpr Real kSums = 1e-12;
  return kSums + rounding_ / moved_;
}

Real Ledger::energy_bound() const {
  constexpr Real kRoundOff = 1e-10;
  const bool first_order = scene_.numerics.integrator == IntegratorId::symplectic_euler;
  const Real of_integrator = first_order ? 3 * phase_ / 2 : 3 * phase_ * phase_ / 6;
  return of_integrator + kRoundOff + 2 * liquid_energy_ / energy_scale_;
}

}  // namespace vat::stability
