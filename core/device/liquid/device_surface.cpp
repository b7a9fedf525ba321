#include "core/device/liquid/device_surface.h"

#include <array>
#include <cmath>
#include <span>

#include "core/device/common/kernel_values.h"
#include "core/laws/surface_tension.h"
#include "core/liquid/pairs/coupled_pairs.h"
#include "core/liquid/surface/surface_tension.h"

namespace vat {
namespace {

using opencl::Program;

constexpr std::size_t kSurfaceSums = 6;  // SURFACE_SUMS of surface.cl

/// The struct Balance of surface.cl.
struct BalanceParameters {
  double excess[3];
  double turn[3];
  double center[3];
};

SurfaceParameters surface_parameters(const Model& model) {
  const Index material = model.material[0];
  const LiquidModel& liquid = *model.liquids[material];
  const Real h = liquid.support_radius;
  const Real slope = slope_factor(model, liquid);
  const Real cosine = model.wall_cosines[material];
  SurfaceParameters s{};
  s.slope = static_cast<float>(slope);
  s.threshold = static_cast<float>(kSurfaceThreshold / h);
  s.spread = static_cast<float>(slope / liquid.slope_scale);
  s.lift = static_cast<float>((kSurfaceDepth / (model.scene.dimensions - 1) + kSurfaceBulge) * h);
  s.tension = static_cast<float>(2 * liquid.surface_tension / liquid.rest_density);
  s.cohesion = static_cast<float>(2 * kCohesion * liquid.surface_tension / h);
  s.cosine = static_cast<float>(cosine);
  s.sine = static_cast<float>(std::sqrt(1 - cosine * cosine));
  return s;
}

/// The sums of the kernel sum_surface.
SurfaceSum surface_sum(const std::array<Double4, kSurfaceSums>& sums) {
  const auto vector = [&](std::size_t k) { return Vec3(sums[k].x, sums[k].y, sums[k].z); };
  SurfaceSum all;
  all.force = vector(0);
  all.torque = vector(1);
  all.moment = vector(2);
  all.share = sums[3].x;
  all.second_moment << sums[3].y, sums[4].y, sums[4].z,  //
      sums[4].y, sums[3].z, sums[5].x,                   //
      sums[4].z, sums[5].x, sums[4].x;
  return all;
}

BalanceParameters to_kernel(const SurfaceBalance& balance) {
  BalanceParameters parameters{};
  store(balance.excess, parameters.excess);
  store(balance.turn, parameters.turn);
  store(balance.center, parameters.center);
  return parameters;
}

}  // namespace

DeviceSurface::DeviceSurface(Program& program, const Model& model)
    : program_(program),
      parameters_(surface_parameters(model)),
      liquid_count_(model.liquid_count),
      is_periodic_(model.periodic.any()),
      is_balanced_(model.walls.empty() && model.particle_count == model.liquid_count),
      surface_(program, model.particle_count * sizeof(Float4)),
      normals_(program, model.particle_count * sizeof(Float4)),
      curved_(program, model.particle_count * sizeof(Float4)),
      partial_(program, kSurfaceSums * bytes_of_partial(model.liquid_count)),
      results_(program, kSurfaceSums * sizeof(Double4)) {}

std::size_t DeviceSurface::bytes_for(const Model& model) {
  return 3 * model.particle_count * sizeof(Float4) +
         kSurfaceSums * (bytes_of_partial(model.liquid_count) + sizeof(Double4));
}

void DeviceSurface::add_forces(const LiquidParameters& p, const DeviceParticles& s,
                               const opencl::Buffer& acceleration) {
  program_.run("find_surface", s.count(), p, parameters_, s.cells.begins, s.sorted_place,
               s.neighbour_counts, s.neighbours, surface_);
  program_.run("find_surface_normals", s.count(), p, parameters_, s.cells.begins, s.sorted_place,
               s.neighbour_counts, s.neighbours, surface_, normals_);
  program_.run("find_curvature_forces", s.count(), p, parameters_, s.cells.begins, s.order,
               s.sorted_place, s.neighbour_counts, s.neighbours, surface_, normals_, curved_,
               acceleration);
  SurfaceBalance balance;
  if (is_balanced_) {
    const std::int32_t groups = groups_of(liquid_count_);
    program_.run("sum_surface", liquid_count_, p, groups, s.sorted_place, normals_, curved_,
                 partial_);
    program_.run("end_surface_sums", Program::kGroup, groups, partial_, results_);
    std::array<Double4, kSurfaceSums> sums{};
    program_.read(results_, std::span<Double4>(sums));
    balance = balance_of(surface_sum(sums), !is_periodic_);
  }
  program_.run("add_curvature_forces", s.count(), p, to_kernel(balance), s.order, s.sorted_place,
               normals_, curved_, acceleration);
}

}  // namespace vat
