#include "core/device/liquid/device_cohesion.h"

#include <span>
#include <vector>

#include "core/kernels/cohesion_kernel.h"

namespace vat {
namespace {

/// The integral over the plane at distance 0 of the kernel wendland_over_plane().
Real over_plane_at_zero(int dimensions) {
  return dimensions == 3 ? Real{1} / 18 : Real{8} / 27;
}

CohesionParameters cohesion_parameters(const Model& model) {
  const Index material = model.material[0];
  const LiquidModel& liquid = *model.liquids[material];
  const CohesionKernel& kernel = *model.cohesion;
  const Real scale = liquid.kernel.scale();
  const Real attraction = model.cohesions[material];
  const int dimensions = model.scene.dimensions;
  const Real of_plane = attraction / liquid.rest_density / over_plane_at_zero(dimensions);
  const Real near_slope = kernel.slope_over_r(0, 0);
  const Real near_plane = kernel.over_plane(0, 0);
  CohesionParameters c{};
  c.pull = static_cast<float>(attraction * liquid.support_radius / (liquid.rest_density * scale));
  c.pull_of_solid = static_cast<float>(attraction * liquid.support_radius / (scale * scale));
  c.inverse_far = static_cast<float>(1 / CohesionKernel::kReach);
  c.inverse_near = static_cast<float>(1 / CohesionKernel::kCore);
  c.far_slope = static_cast<float>(kernel.slope_over_r(0, 1) - near_slope);
  c.near_slope = static_cast<float>(near_slope);
  c.far_plane = static_cast<float>(of_plane * (kernel.over_plane(0, 1) - near_plane));
  c.near_plane = static_cast<float>(of_plane * near_plane);
  c.wall_share = static_cast<float>(model.adhesion_share(material, {}));
  c.dimensions = dimensions;
  return c;
}

/// The parameters with the reach of the cohesion, which is twice that of the density. Walls attract
/// as planes, without images.
LiquidParameters with_reach_of_cohesion(LiquidParameters p) {
  static_assert(CohesionKernel::kReach == 2);
  p.reach *= 2;
  p.support *= 2;
  p.sides &= ~p.walls;
  return p;
}

}  // namespace

DeviceCohesion::DeviceCohesion(opencl::Program& program, const Model& model)
    : program_(program),
      parameters_(cohesion_parameters(model)),
      shares_(program, model.particle_count * sizeof(float)) {
  std::vector<float> shares(model.particle_count, 1);
  for (Index i = model.liquid_count; i < model.particle_count; ++i) {
    shares[i] = static_cast<float>(model.adhesion_share(model.material[0], model.material[i]));
  }
  program_.write(shares_, std::span<const float>(shares));
}

std::size_t DeviceCohesion::bytes_for(const Model& model) {
  return model.particle_count * sizeof(float);
}

void DeviceCohesion::add_forces(const LiquidParameters& p, const DeviceParticles& s,
                                const opencl::Buffer& acceleration) {
  program_.run("add_cohesion", s.count(), with_reach_of_cohesion(p), parameters_, s.cells.begins,
               s.order, s.sorted_place, shares_, acceleration);
}

void DeviceCohesion::add_forces_on_solids(const LiquidParameters& p, const DeviceParticles& s,
                                          const opencl::Buffer& force) {
  program_.run("add_adhesion_on_solids", s.count(), with_reach_of_cohesion(p), parameters_,
               s.cells.begins, s.order, s.sorted_place, shares_, force);
}

}  // namespace vat
