#include "core/device/solid/device_integration.h"

#include <algorithm>

#include "core/device/common/kernel_values.h"

namespace vat {
namespace {

using opencl::Program;

std::size_t bytes_of_poses(const Model& model) {
  return std::max<std::size_t>(1, model.rigid_bodies.size()) * DeviceRigidBodies::kPoseBytes;
}

}  // namespace

DeviceIntegration::DeviceIntegration(Program& program, const Model& model)
    : program_(program),
      free_(SolidRange(model).free),
      bodies_(model.rigid_bodies.size()),
      start_(program, SolidRange(model).count),
      sum_(program, SolidRange(model).count),
      start_poses_(program, bytes_of_poses(model)),
      sum_of_rates_(program, bytes_of_poses(model)) {}

std::size_t DeviceIntegration::bytes_for(const Model& model) {
  return 2 * (SolidRange(model).count * DeviceMotion::kBytes + bytes_of_poses(model));
}

void DeviceIntegration::take_euler_step(const SolidParameters& p, Real kick, Real dt,
                                        const SteppedSolids& solids,
                                        const opencl::Buffer& counters) {
  const SolidTables& t = solids.tables;
  const DeviceRigidBodies& r = solids.rigid;
  if (free_ > 0) {
    program_.run("take_euler_step", free_, p, kick, dt, solids.motion.position,
                 solids.motion.velocity, solids.force, t.mobility, t.body_of, t.bodies, counters);
  }
  if (bodies_ > 0) {
    program_.run("take_euler_step_of_bodies", bodies_, p, number_of(bodies_), dt, r.rigid, r.force,
                 r.poses, counters);
  }
}

void DeviceIntegration::begin(const SteppedSolids& solids) {
  if (free_ > 0) {
    start_.copy_from(solids.motion);
    program_.fill_with_zeros(sum_.position, free_ * DeviceMotion::kBytes / 2);
    program_.fill_with_zeros(sum_.velocity, free_ * DeviceMotion::kBytes / 2);
  }
  if (bodies_ > 0) {
    program_.copy(solids.rigid.poses, start_poses_, bodies_ * DeviceRigidBodies::kPoseBytes);
    program_.fill_with_zeros(sum_of_rates_, bodies_ * DeviceRigidBodies::kPoseBytes);
  }
}

void DeviceIntegration::advance(Real weight, Real way, const SteppedSolids& solids) {
  const DeviceRigidBodies& r = solids.rigid;
  if (free_ > 0) {
    program_.run("advance_stage", free_, number_of(free_), weight, way, solids.motion.position,
                 solids.motion.velocity, start_.position, start_.velocity, sum_.position,
                 sum_.velocity, solids.force, solids.tables.mobility);
  }
  if (bodies_ > 0) {
    program_.run("advance_stage_of_bodies", bodies_, number_of(bodies_), weight, way, r.rigid,
                 r.force, start_poses_, sum_of_rates_, r.poses);
  }
}

void DeviceIntegration::end(const SolidParameters& p, Real dt, const SteppedSolids& solids,
                            const opencl::Buffer& counters) {
  const SolidTables& t = solids.tables;
  const DeviceRigidBodies& r = solids.rigid;
  if (free_ > 0) {
    program_.run("end_stages", free_, p, dt, solids.motion.position, solids.motion.velocity,
                 start_.position, start_.velocity, sum_.position, sum_.velocity, t.mobility,
                 t.body_of, t.bodies, counters);
  }
  if (bodies_ > 0) {
    program_.run("end_stages_of_bodies", bodies_, p, number_of(bodies_), dt, r.rigid, start_poses_,
                 sum_of_rates_, r.poses, counters);
  }
}

}  // namespace vat
