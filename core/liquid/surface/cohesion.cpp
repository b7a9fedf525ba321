#include "core/liquid/surface/cohesion.h"
#include "core/liquid/pairs/scratch.h"

#include <algorithm>
#include <array>

#include "core/liquid/pairs/liquid_pairs.h"
#include "core/liquid/pairs/weakly_compressible_pairs.h"
#include "core/support/check.h"

namespace vat {
namespace {

/// Particles have many neighbours, and different numbers of them. Small blocks keep all threads
/// busy.
constexpr std::size_t kTargetsPerBlock = 32;

Vec3 place_of(const CellSortedPoints& points, Index slot) {
  return {points.x[slot], points.y[slot], points.z[slot]};
}

/// Calls f(slot, x) for points closer to `place` than `reach`, with x pointing from the point to
/// `place`. For each run of slots it first finds the near points, without mispredicted branches.
template <class F>
void for_each_near(const Model& model, const CellSortedPoints& points, const Vec3& place,
                   Real reach, F&& f) {
  constexpr Index kChunk = 128;
  std::array<Index, kChunk> near;
  const auto search_run = [&](const Vec3& from, Index begin, Index end) {
    const Real x = from.x();
    const Real y = from.y();
    const Real z = from.z();
    std::size_t count = 0;
    for (Index slot = begin; slot < end; ++slot) {
      const Real dx = x - points.x[slot];
      const Real dy = y - points.y[slot];
      const Real dz = z - points.z[slot];
      near[count] = slot;
      count += static_cast<std::size_t>(dx * dx + dy * dy + dz * dz < reach * reach);
    }
    for (std::size_t k = 0; k < count; ++k) f(near[k], Vec3(from - place_of(points, near[k])));
  };
  const auto search = [&](const Vec3& from) {
    points.grid.for_each_run(from, reach, [&](Index begin, Index end) {
      for (; begin < end; begin += std::min(kChunk, end - begin)) {
        search_run(from, begin, std::min(end, begin + kChunk));
      }
    });
  };
  if (!model.periodic.any()) {
    search(place);
    return;
  }
  model.periodic.for_each_image(place, reach, [&](const Vec3& shift) { search(place + shift); });
}

/// The force of a particle at -x, divided by A and the volume of the other particle.
Vec3 pull(const CohesionKernel& kernel, Real share, Real volume, const Vec3& x) {
  return (volume * kernel.slope_over_r(x.norm(), share)) * x;
}

/// The force of the walls, divided by A and the particle's volume.
Vec3 pull_of_walls(const Model& model, const VatMotion& motion, Real share, const Vec3& place) {
  Vec3 sum = Vec3::Zero();
  for (const int wall : model.walls) {
    const Real distance = wall_distance(*model.scene.vat, motion, wall, place);
    if (distance >= model.cohesion->reach()) continue;
    sum -= model.cohesion->over_plane(std::max(Real{0}, distance), share) * wall_normal(wall);
  }
  return sum;
}

}  // namespace

void add_cohesion(StepContext& c) {
  const Model& model = c.model;
  VAT_CHECK(model.cohesion && model.rest_volume.size() == model.particle_count);
  const CellSortedPoints& points = c.work.of<LiquidScratch>().liquid;
  const std::span<const Index> order = points.grid.order();
  const CohesionKernel& kernel = *model.cohesion;
  const VatMotion motion = motion_of(c);
  for_blocks<kTargetsPerBlock>(c.runner, order.size(), [&](std::size_t begin, std::size_t end) {
    for (std::size_t slot = begin; slot < end; ++slot) {
      const Index i = order[slot];
      const Index material = model.material[i];
      const Real attraction = model.cohesions[material];
      if (attraction == 0) continue;
      const Vec3 place = place_of(points, static_cast<Index>(slot));
      Vec3 sum = Vec3::Zero();
      for_each_near(model, points, place, kernel.reach(), [&](Index other, const Vec3& x) {
        const Index j = order[other];
        if (model.material[j] == material) sum += pull(kernel, 1, model.rest_volume[j], x);
      });
      if (!model.walls.empty()) {
        sum += pull_of_walls(model, motion, model.adhesion_share(material, {}), place);
      }
      c.forces.particle[i] += (attraction * model.rest_volume[i]) * sum;
    }
  });
}

namespace {

/// Whether no force moves the particle in this step.
bool is_held(const StepContext& c, Index i) {
  const ModelBody& body = c.model.bodies[c.model.body[i]];
  if (body.kind != BodyKind::rigid) return c.model.inverse_mass[i] == 0;
  return c.model.rigid_bodies[body.rigid].is_held(c.step);
}

/// Adds the forces on the points of one kind, whose first one is particle `first`, by those of the
/// other kind. Held particles get no force. pull(i, j, x) is the force on i, divided by the volume
/// of i.
template <class Pull>
void add_pulls(StepContext& c, const CellSortedPoints& points, Index first,
               const CellSortedPoints& others, Index first_other, Pull&& pull) {
  const std::span<const Index> order = points.grid.order();
  const Real reach = c.model.cohesion->reach();
  for_blocks<kTargetsPerBlock>(c.runner, order.size(), [&](std::size_t begin, std::size_t end) {
    for (std::size_t slot = begin; slot < end; ++slot) {
      const Index i = first + order[slot];
      if (is_held(c, i)) continue;
      const Vec3 place = place_of(points, static_cast<Index>(slot));
      Vec3 sum = Vec3::Zero();
      for_each_near(c.model, others, place, reach, [&](Index other, const Vec3& x) {
        sum += pull(i, first_other + others.grid.order()[other], x);
      });
      c.forces.particle[i] += c.model.rest_volume[i] * sum;
    }
  });
}

}  // namespace

void add_adhesion(StepContext& c) {
  LiquidScratch& buffers = c.work.of<LiquidScratch>();
  const Model& model = c.model;
  const CellSortedPoints& liquid = buffers.liquid;
  const CellSortedPoints& solids = buffers.solids_in_liquid;
  const auto pull_of = [&](Index in_liquid, Index in_solid, Index other, const Vec3& x) {
    const Index material = model.material[in_liquid];
    const Real share = model.adhesion_share(material, model.material[in_solid]);
    return Vec3(model.cohesions[material] *
                pull(*model.cohesion, share, model.rest_volume[other], x));
  };
  add_pulls(c, liquid, 0, solids, model.liquid_count,
            [&](Index i, Index j, const Vec3& x) { return pull_of(i, j, j, x); });
  add_pulls(c, solids, model.liquid_count, liquid, 0,
            [&](Index i, Index j, const Vec3& x) { return pull_of(j, i, j, x); });
}

}  // namespace vat
