#include "core/device/solid/device_rigid_bodies.h"

#include <algorithm>
#include <cmath>
#include <span>

#include "core/device/common/kernel_values.h"
#include "core/laws/vat_motion.h"
#include "core/limits.h"
#include "core/support/check.h"

namespace vat {
namespace {

using opencl::Buffer;
using opencl::Program;

/// The struct Drive of rigid.cl.
struct Drive {
  double way[3];
  double velocity[3];
};

constexpr std::size_t kRigidVector = 3 * sizeof(double);
constexpr std::size_t kResultant = 2 * kRigidVector;

std::size_t at_least_one(std::size_t count) {
  return std::max<std::size_t>(1, count);
}

}  // namespace

DeviceRigidBodies::Constants DeviceRigidBodies::constants_of(const Model& model,
                                                             const GuardBounds& bounds,
                                                             std::size_t b) {
  const RigidModel& rigid = model.rigid_bodies[b];
  Constants c{};
  c.mass = rigid.mass;
  c.inverse_mass = rigid.inverse_mass;
  c.extent = bounds.extent[b];
  c.travel = bounds.travel[rigid.body];
  c.greatest_inverse_moment = rigid.inverse_moments.maxCoeff();
  store(rigid.inertia, c.inertia);
  store(rigid.inverse_inertia, c.inverse_inertia);
  store(rigid.principal_axes, c.principal_axes);
  store(rigid.inverse_moments, c.inverse_moments);
  if (rigid.axle) {
    const auto& [direction, damping] = *rigid.axle;
    store(direction, c.axle);
    // The axle is at rest in the body, so that the moment about it is constant.
    const Real step = model.scene.numerics.step;
    c.brake = std::exp(-damping * rigid.inverse_moments.maxCoeff() * step);
    c.has_axle = 1;
  }
  c.is_driven = rigid.motion ? 1 : 0;
  std::ranges::copy(rigid.splitting, c.splitting);
  c.begin = static_cast<std::int32_t>(rigid.particles.begin - SolidRange(model).first);
  c.end = static_cast<std::int32_t>(rigid.particles.end - SolidRange(model).first);
  c.body = static_cast<std::int32_t>(rigid.body);
  return c;
}

DeviceRigidBodies::DeviceRigidBodies(Program& program, const Model& model,
                                     const GuardBounds& bounds)
    : rigid(program, at_least_one(model.rigid_bodies.size()) * sizeof(Constants)),
      rigid_of(program,
               at_least_one(model.particle_count - model.free_count) * sizeof(std::int32_t)),
      poses(program, at_least_one(model.rigid_bodies.size()) * sizeof(Pose)),
      force(program, at_least_one(model.rigid_bodies.size()) * kResultant),
      spins(program, model.bodies.size() * kRigidVector),
      torque(program, SolidRange(model).count * kRigidVector),
      loads(program, SolidRange(model).count * 2 * sizeof(double)),
      program_(program),
      count_(model.rigid_bodies.size()),
      particles_(model.particle_count - model.free_count),
      local_position_(program, at_least_one(particles_) * kRigidVector),
      speeds_(program, model.bodies.size() * kRigidVector),
      saved_poses_(program, at_least_one(count_) * sizeof(Pose)),
      saved_force_(program, at_least_one(count_) * kResultant) {
  program.fill_with_zeros(spins, model.bodies.size() * kRigidVector);
  if (count_ == 0) return;
  std::vector<std::int32_t> owners(particles_);
  for (std::size_t b = 0; b < count_; ++b) {
    constants_.push_back(constants_of(model, bounds, b));
    const IndexRange& particles = model.rigid_bodies[b].particles;
    std::fill(owners.begin() + (particles.begin - model.free_count),
              owners.begin() + (particles.end - model.free_count), static_cast<std::int32_t>(b));
  }
  program.write(rigid_of, std::span<const std::int32_t>(owners));
  program.write(local_position_, std::span<const Vec3>(model.local_position));
}

std::size_t DeviceRigidBodies::bytes_for(const Model& model) {
  return model.rigid_bodies.size() * (sizeof(Constants) + 2 * (sizeof(Pose) + kResultant)) +
         (model.particle_count - model.free_count) * (kRigidVector + sizeof(std::int32_t)) +
         model.bodies.size() * 2 * kRigidVector +
         SolidRange(model).count * (kRigidVector + 2 * sizeof(double));
}

void DeviceRigidBodies::write(const Model& model, const State& state) {
  VAT_CHECK(state.now.rigid.size() == count_ && state.forces.rigid_force.size() == count_ &&
            state.forces.rigid_torque.size() == count_);
  if (count_ == 0) return;
  read_poses_.clear();
  read_forces_.clear();
  for (std::size_t b = 0; b < count_; ++b) {
    const RigidState& body = state.now.rigid[b];
    Pose& pose = read_poses_.emplace_back();
    store(body.center_of_mass, pose.center);
    store(body.orientation, pose.orientation);
    store(body.momentum, pose.momentum);
    store(body.angular_momentum, pose.angular_momentum);
    read_forces_.push_back(state.forces.rigid_force[b]);
    read_forces_.push_back(state.forces.rigid_torque[b]);
  }
  hold(model, state.step_count);
  program_.write(poses, std::span<const Pose>(read_poses_));
  program_.write(force, std::span<const Vec3>(read_forces_));
}

void DeviceRigidBodies::hold(const Model& model, std::uint64_t step) {
  if (count_ == 0) return;
  for (std::size_t b = 0; b < count_; ++b) {
    constants_[b].is_held = model.rigid_bodies[b].is_held(step) ? 1 : 0;
  }
  program_.write(rigid, std::span<const Constants>(constants_));
}

void DeviceRigidBodies::read() {
  read_poses_.resize(count_);
  read_forces_.resize(2 * count_);
  if (count_ == 0) return;
  program_.read(poses, std::span(read_poses_));
  program_.read(force, std::span(read_forces_));
}

RigidState DeviceRigidBodies::state_of(const Pose& pose) {
  return {Vec3(pose.center), Quat(pose.orientation), Vec3(pose.momentum),
          Vec3(pose.angular_momentum)};
}

void DeviceRigidBodies::read_states(std::vector<RigidState>& states) {
  states.clear();
  if (count_ == 0) return;
  read_poses_.resize(count_);
  program_.read(poses, std::span(read_poses_));
  for (const Pose& pose : read_poses_) states.push_back(state_of(pose));
}

void DeviceRigidBodies::copy_to(State& state) const {
  for (std::size_t b = 0; b < count_; ++b) {
    state.now.rigid[b] = state_of(read_poses_[b]);
    state.forces.rigid_force[b] = read_forces_[2 * b];
    state.forces.rigid_torque[b] = read_forces_[2 * b + 1];
  }
}

void DeviceRigidBodies::save() {
  if (count_ == 0) return;
  program_.copy(poses, saved_poses_, count_ * sizeof(Pose));
  program_.copy(force, saved_force_, count_ * kResultant);
}

void DeviceRigidBodies::restore() {
  if (count_ == 0) return;
  program_.copy(saved_poses_, poses, count_ * sizeof(Pose));
  program_.copy(saved_force_, force, count_ * kResultant);
}

void DeviceRigidBodies::move(const SolidParameters& p, Real step, const Buffer& counters) {
  if (count_ == 0) return;
  program_.run("move_rigid_bodies", count_, p, static_cast<std::int32_t>(count_), step, rigid,
               force, poses, speeds_, spins, counters);
}

void DeviceRigidBodies::drive_body(std::size_t b, const Vec3& way, const Vec3& velocity) {
  Drive drive{};
  store(way, drive.way);
  store(velocity, drive.velocity);
  program_.run("drive_rigid_body", 1, static_cast<std::int32_t>(b), drive, rigid, poses, speeds_);
}

void DeviceRigidBodies::drive(const Model& model, Real start, Real end) {
  for (std::size_t b = 0; b < count_; ++b) {
    const std::optional<SlideMotion>& motion = model.rigid_bodies[b].motion;
    if (!motion) continue;
    const VatMotion to = slide_motion(*motion, end);
    drive_body(b, to.offset - slide_motion(*motion, start).offset, to.velocity);
  }
}

void DeviceRigidBodies::begin_drive(const Model& model, Real start, Real step) {
  for (std::size_t b = 0; b < count_; ++b) {
    const std::optional<SlideMotion>& motion = model.rigid_bodies[b].motion;
    if (!motion) continue;
    const Vec3 way =
        slide_motion(*motion, start + step).offset - slide_motion(*motion, start).offset;
    drive_body(b, Vec3::Zero(), way / step);
  }
}

void DeviceRigidBodies::drift_driven(const Model& model, Real start, Real dt) {
  for (std::size_t b = 0; b < count_; ++b) {
    const std::optional<SlideMotion>& motion = model.rigid_bodies[b].motion;
    if (!motion) continue;
    const Vec3 velocity = slide_motion(*motion, start).velocity;
    drive_body(b, dt * velocity, velocity);
  }
}

void DeviceRigidBodies::kick(Real dt) {
  if (count_ == 0) return;
  program_.run("kick_rigid_bodies", count_, number_of(count_), dt, force, poses);
}

void DeviceRigidBodies::check(const SolidParameters& p, Real step, const Buffer& counters) {
  if (count_ == 0) return;
  program_.run("check_rigid_bodies", count_, p, number_of(count_), step, rigid, poses, counters);
}

void DeviceRigidBodies::finish(const SolidParameters& p, Real step, const Buffer& counters) {
  if (count_ == 0) return;
  program_.run("finish_rigid_bodies", count_, p, static_cast<std::int32_t>(count_), step, rigid,
               force, poses, counters);
}

void DeviceRigidBodies::pose(const SolidParameters& p, const Buffer& position,
                             const Buffer& predicted, const Buffer& counters) {
  if (count_ == 0) return;
  program_.run("pose_rigid_particles", particles_, p, rigid, rigid_of, local_position_, poses,
               speeds_, spins, position, predicted, counters);
}

void DeviceRigidBodies::gather(bool has_friction, const Buffer& position, const Buffer& radius,
                               const Buffer& particle_force, const Buffer& bounds) {
  if (count_ == 0) return;
  program_.run_in_lanes("gather_rigid_forces", count_ * Program::kGroup, std::int32_t{has_friction},
                        rigid, poses, position, radius, particle_force, torque, loads, force,
                        bounds);
}

}  // namespace vat
