#include "core/device/gas/device_gas.h"

#include <optional>
#include <span>
#include <vector>

#include "core/device/common/kernel_values.h"
#include "core/laws/vat_motion.h"
#include "core/support/check.h"

namespace vat {
namespace {

using opencl::Buffer;
using opencl::Program;

/// The struct Gas of forces.cl.
struct Gas {
  double support, density_scale, pressure_slope, viscosity, rest_density, stiffness, wall_viscosity;
};
/// The struct GasStep of forces.cl.
struct GasStep {
  double drag;
  double still[3];
  std::int32_t no_slip;
  std::int32_t padding;
};

constexpr std::size_t kVolumeAndPressure = 2 * sizeof(double);

/// Forces that the scene excludes have the factor 0.
Gas gas_of(const Model& model, const LiquidModel& liquid) {
  const Real h = liquid.support_radius;
  const ForceSwitches& acting = model.scene.forces;
  return {h,
          liquid.density_kernel.value(0) / (h * h * h * h * h * h),
          -liquid.pressure_kernel.slope(0) / (h * h),
          acting.viscosity ? liquid.viscosity * liquid.viscosity_kernel.laplacian_scale() : 0,
          liquid.rest_density,
          acting.pressure ? liquid.pressure_share * liquid.stiffness : 0,
          acting.viscosity ? liquid.viscosity : 0};
}

Buffer make_gases(Program& program, const Model& model) {
  std::vector<Gas> gases;
  for (const std::optional<LiquidModel>& liquid : model.liquids) {
    gases.push_back(liquid ? gas_of(model, *liquid) : Gas{});
  }
  Buffer buffer(program, gases.size() * sizeof(Gas));
  program.write(buffer, std::span<const Gas>(gases));
  return buffer;
}

GasStep step_of(const Model& model, Real end) {
  GasStep step{};
  const Scene& scene = model.scene;
  if (scene.settling && end < scene.settling->until) {
    step.drag = scene.settling->drag;
    if (scene.vat) store(vat_motion(*scene.vat, end).velocity, step.still);
  }
  for (const int wall : model.no_slip_walls) step.no_slip |= 1 << wall;
  return step;
}

}  // namespace

DeviceGas::DeviceGas(Program& program, const Model& model)
    : program_(program),
      gases_(make_gases(program, model)),
      volume_and_pressure_(program, model.particle_count * kVolumeAndPressure),
      sorted_velocity_(program, model.particle_count * sizeof(Double4)) {
  VAT_CHECK(model.liquid_count > 0 && !model.is_coupled);
}

std::size_t DeviceGas::bytes_for(const Model& model) {
  return model.liquids.size() * sizeof(Gas) +
         model.particle_count * (kVolumeAndPressure + sizeof(Double4));
}

void DeviceGas::add_forces(const Model& model, const DeviceSolids& bodies, Real end) {
  const SolidParameters p = bodies.parameters(end);
  const PlacedSolids at = bodies.placed();
  const SolidTables& t = at.tables;
  const GasStep step = step_of(model, end);
  program_.run("find_gas_pressure", model.particle_count, p, step, at.cells.begins, at.order,
               at.sorted, at.predicted, t.mass, t.body_of, t.bodies, gases_,
               volume_and_pressure_, sorted_velocity_);
  program_.run("add_gas_forces", model.particle_count, p, step, at.cells.begins, at.order,
               at.sorted, volume_and_pressure_, sorted_velocity_, t.mass, t.body_of,
               t.bodies, gases_, bodies.force());
}

}  // namespace vat
