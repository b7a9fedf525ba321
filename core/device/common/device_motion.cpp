#include "core/device/common/device_motion.h"

#include <algorithm>

#include "core/device/common/kernel_values.h"
#include "core/support/check.h"

namespace vat {

using opencl::Program;

namespace {

/// The struct PeriodicBox of state.cl.
struct KernelBox {
  double low[3];
  double length[3];
};

}  // namespace

DeviceMotion::DeviceMotion(Program& program, std::size_t particles)
    : position(program, particles * sizeof(Vec3)),
      velocity(program, particles * sizeof(Vec3)),
      program_(program),
      count_(particles) {
  static_assert(sizeof(Vec3) == 3 * sizeof(double));
}

void DeviceMotion::write(const Configuration& from, std::size_t first) {
  VAT_CHECK(from.position.size() >= first + count_ && from.velocity.size() >= first + count_);
  program_.write(position, std::span(from.position).subspan(first, count_));
  program_.write(velocity, std::span(from.velocity).subspan(first, count_));
}

void DeviceMotion::copy_from(const DeviceMotion& other) {
  VAT_CHECK(other.count_ == count_);
  program_.copy(other.position, position, count_ * sizeof(Vec3));
  program_.copy(other.velocity, velocity, count_ * sizeof(Vec3));
}

void DeviceMotion::wrap_liquid(const Model& model) {
  if (!model.periodic.any() || model.liquid_count == 0) return;
  VAT_CHECK(model.liquid_count <= count_);
  KernelBox box{};
  for (int axis = 0; axis < 3; ++axis) {
    if (!model.periodic.repeats(axis)) continue;
    box.low[axis] = model.scene.periodic->min[axis];
    box.length[axis] = model.periodic.length(axis);
  }
  program_.run("wrap_particles", model.liquid_count, number_of(model.liquid_count), box, position);
}

void ReadMotion::read(Program& program, const DeviceMotion& from, std::size_t particles) {
  positions_.resize(particles);
  velocities_.resize(particles);
  program.read(from.position, std::span(positions_));
  program.read(from.velocity, std::span(velocities_));
}

void ReadMotion::copy_to(Configuration& to, std::size_t first) const {
  VAT_CHECK(to.position.size() >= first + positions_.size() &&
            to.velocity.size() >= first + velocities_.size());
  const auto at = static_cast<std::ptrdiff_t>(first);
  std::ranges::copy(positions_, to.position.begin() + at);
  std::ranges::copy(velocities_, to.velocity.begin() + at);
}

}  // namespace vat
