#include "core/device/tait/device_liquid_integration.h"

#include "core/device/common/kernel_values.h"

namespace vat {
namespace {

/// The argument of a kernel in place of transport velocities that do not exist.
const opencl::Buffer& transport_or_other(const SteppedLiquid& liquid) {
  return liquid.transport != nullptr ? *liquid.transport : liquid.acceleration;
}

std::int32_t has_transport(const SteppedLiquid& liquid) {
  return liquid.transport != nullptr ? 1 : 0;
}

}  // namespace

DeviceLiquidIntegration::DeviceLiquidIntegration(opencl::Program& program, const Model& model)
    : program_(program),
      count_(model.liquid_count),
      start_(program, count_),
      sum_(program, count_) {}

std::size_t DeviceLiquidIntegration::bytes_for(const Model& model) {
  return 2 * model.liquid_count * DeviceMotion::kBytes;
}

void DeviceLiquidIntegration::take_euler_step(const LiquidParameters& p, Real dt,
                                              const SteppedLiquid& liquid,
                                              const opencl::Buffer& counters) {
  program_.run("take_liquid_euler_step", count_, p, dt, has_transport(liquid),
               liquid.motion.position, liquid.motion.velocity, liquid.acceleration,
               transport_or_other(liquid), counters);
}

void DeviceLiquidIntegration::begin(const SteppedLiquid& liquid) {
  start_.copy_from(liquid.motion);
  program_.fill_with_zeros(sum_.position, count_ * DeviceMotion::kBytes / 2);
  program_.fill_with_zeros(sum_.velocity, count_ * DeviceMotion::kBytes / 2);
}

void DeviceLiquidIntegration::advance(Real weight, Real way, const SteppedLiquid& liquid) {
  program_.run("advance_liquid_stage", count_, number_of(count_), weight, way,
               has_transport(liquid), liquid.motion.position, liquid.motion.velocity,
               start_.position, start_.velocity, sum_.position, sum_.velocity, liquid.acceleration,
               transport_or_other(liquid));
}

void DeviceLiquidIntegration::end(const LiquidParameters& p, Real dt, const SteppedLiquid& liquid,
                                  const opencl::Buffer& counters) {
  program_.run("end_liquid_stages", count_, p, dt, liquid.motion.position, liquid.motion.velocity,
               start_.position, start_.velocity, sum_.position, sum_.velocity, counters);
}

}  // namespace vat
