#include "core/device/solid/device_damping.h"

#include <algorithm>
#include <span>

#include "core/damping/damping_solve.h"
#include "core/device/common/kernel_values.h"
#include "core/support/check.h"

namespace vat {
namespace {

using opencl::Program;

constexpr std::size_t kColumn = 3 * sizeof(double);
constexpr std::size_t kMostContacts = 16;                 // MOST_CONTACTS of forces.cl
constexpr std::size_t kMostSlots = std::size_t{1} << 27;  // of IMAGE_BIT

std::size_t slots_of_memory(const Model& model) {
  return model.damping.any ? SolidRange(model).count : 1;
}
std::size_t ways_of_memory(const Model& model) {
  return std::max<std::size_t>(1, model.damping.any ? model.spring_ends.size() : 0);
}

/// The bytes of the partial sums of the groups of particles and of the rigid bodies.
std::size_t bytes_of_sums(const Model& model) {
  return (static_cast<std::size_t>(groups_of(SolidRange(model).count)) +
          model.rigid_bodies.size()) *
         4 * sizeof(double);
}

/// The bytes of a vector of the solve: particles, and two entries for each rigid body.
std::size_t bytes_of_vector(const Model& model) {
  return (SolidRange(model).count + 2 * model.rigid_bodies.size()) * kColumn;
}

}  // namespace

RememberedForces::RememberedForces(Program& program, const Model& model)
    : is_used(model.damping.any ? 1 : 0),
      contact_counts(program, slots_of_memory(model) * sizeof(std::int32_t)),
      contacts(program, slots_of_memory(model) * kMostContacts * sizeof(std::uint32_t)),
      ways(program, ways_of_memory(model) * kColumn) {
  VAT_CHECK(SolidRange(model).count <= kMostSlots);
}

std::size_t RememberedForces::bytes_for(const Model& model) {
  return slots_of_memory(model) * (sizeof(std::int32_t) + kMostContacts * sizeof(std::uint32_t)) +
         ways_of_memory(model) * kColumn;
}

DampingParameters damping_parameters(Real dt, Real total_mass, std::size_t count) {
  return {dt,
          total_mass,
          kDampingTolerance * kDampingTolerance,
          kDampingVelocityTolerance * kDampingVelocityTolerance,
          number_of(count),
          kMaxDampingPasses};
}

DeviceDamping::DeviceDamping(Program& program, const Model& model)
    : program_(program),
      free_(SolidRange(model).free),
      count_(SolidRange(model).count),
      bodies_(model.rigid_bodies.size()),
      change_(program, bytes_of_vector(model)),
      change_of_force_(program, bytes_of_vector(model)),
      residual_(program, bytes_of_vector(model)),
      direction_(program, bytes_of_vector(model)),
      multiplied_(program, bytes_of_vector(model)),
      torque_(program, count_ * kColumn),
      spin_change_(program, model.bodies.size() * kColumn),
      partial_(program, bytes_of_sums(model)),
      momenta_(program, bytes_of_sums(model)),
      progress_(program, sizeof(DampingProgress)) {
  program.fill_with_zeros(spin_change_, model.bodies.size() * kColumn);
}

void DeviceDamping::find_mass(const Model& model, std::uint64_t step) {
  total_mass_ = 0;
  for (std::size_t i = SolidRange(model).first; i < model.free_count; ++i) {
    if (model.inverse_mass[i] > 0) total_mass_ += model.mass[i];
  }
  for (const RigidModel& rigid : model.rigid_bodies) {
    if (!rigid.is_held(step) && !rigid.axle) total_mass_ += rigid.mass;
  }
}

std::size_t DeviceDamping::bytes_for(const Model& model) {
  return 5 * bytes_of_vector(model) + (SolidRange(model).count + model.bodies.size()) * kColumn +
         2 * bytes_of_sums(model) + sizeof(DampingProgress);
}

void DeviceDamping::begin(const DampingParameters& damping, const PlacedSolids& solids,
                          const opencl::Buffer& force) {
  const std::int32_t groups = groups_of(free_);
  const DeviceRigidBodies& r = solids.rigid;
  if (free_ > 0) {
    program_.run("begin_damping", free_, damping, solids.tables.mass, solids.tables.mobility,
                 solids.velocity, solids.predicted, force, change_, change_of_force_, residual_,
                 direction_, partial_, momenta_);
  }
  if (bodies_ > 0) {
    program_.run("begin_damping_of_bodies", bodies_, damping, number_of(bodies_), number_of(count_),
                 groups, r.rigid, r.poses, r.force, change_, change_of_force_, residual_,
                 direction_, partial_, momenta_);
  }
  program_.run("open_damping", Program::kGroup, damping, groups + number_of(bodies_), partial_,
               momenta_, progress_);
}

void DeviceDamping::iterate(const SolidParameters& p, const DampingParameters& damping,
                            const PlacedSolids& solids) {
  const SolidTables& t = solids.tables;
  const DeviceRigidBodies& r = solids.rigid;
  const RememberedForces& memory = solids.memory;
  const std::int32_t first = number_of(count_);
  const std::int32_t bodies = number_of(bodies_);
  constexpr std::size_t kOne = Program::kGroup;
  if (free_ > 0) {
    program_.run("turn_damping", free_, damping, progress_, t.mobility, residual_, direction_);
  }
  if (bodies_ > 0) {
    program_.run("turn_damping_of_bodies", bodies_, bodies, first, progress_, r.rigid, r.poses,
                 residual_, direction_, spin_change_);
    program_.run("pose_damping", count_ - free_, p, progress_, r.rigid_of, r.poses, solids.position,
                 memory.contact_counts, direction_);
  }
  program_.run("multiply_damping", count_, p, damping, progress_, solids.cells.begins, solids.order,
               solids.sorted, solids.position, solids.predicted, direction_, r.spins, spin_change_,
               t.mass, t.radius, t.body_of, t.bodies, t.laws, t.exclusion_begin, t.exclusions,
               t.spring_begin, t.springs, memory.contact_counts, memory.contacts,
               solids.contact_mobilities, memory.ways, multiplied_, torque_, partial_);
  if (bodies_ > 0) {
    program_.run_in_lanes("multiply_damping_of_bodies", bodies_ * kOne, damping, first,
                          groups_of(count_), r.rigid, r.poses, solids.position, torque_, direction_,
                          memory.contact_counts, multiplied_, partial_);
  }
  program_.run("find_damping_length", kOne, groups_of(count_) + bodies, partial_, progress_);
  if (free_ > 0) {
    program_.run("advance_damping", free_, damping, progress_, t.mass, t.mobility, solids.velocity,
                 solids.predicted, direction_, multiplied_, change_, change_of_force_, residual_,
                 partial_);
  }
  if (bodies_ > 0) {
    program_.run("advance_damping_of_bodies", bodies_, damping, bodies, first, groups_of(free_),
                 progress_, r.rigid, r.poses, direction_, multiplied_, change_, change_of_force_,
                 residual_, partial_);
  }
  program_.run("end_damping_iteration", kOne, damping, groups_of(free_) + bodies, partial_,
               progress_);
}

std::uint32_t DeviceDamping::solve(const SolidParameters& p, const PlacedSolids& solids, Real dt,
                                   const opencl::Buffer& force) {
  const DampingParameters damping = damping_parameters(dt, total_mass_, free_);
  begin(damping, solids, force);
  expected_ = run_iterations(program_, progress_, expected_, [&] { iterate(p, damping, solids); });
  if (free_ > 0) program_.run("end_damping", free_, damping, change_of_force_, force);
  if (bodies_ > 0) {
    program_.run("end_damping_of_bodies", bodies_, number_of(bodies_), number_of(count_),
                 solids.rigid.rigid, change_of_force_, solids.rigid.force);
  }
  return static_cast<std::uint32_t>(expected_);
}

}  // namespace vat
