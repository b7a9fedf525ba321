#include "core/liquid/surface/surface_tension.h"
#include "core/liquid/pairs/scratch.h"
#include "core/liquid/surface/scratch.h"

#include <Eigen/Cholesky>
#include <algorithm>

#include "core/liquid/pairs/liquid_pairs.h"
#include "core/liquid/pairs/weakly_compressible_pairs.h"
#include "core/support/check.h"

namespace vat {
namespace {

/// A liquid particle and its neighbourhood.
struct Neighbourhood {
  const StepContext& c;
  const VatMotion& motion;
  Index slot;

  Index particle_of(Index other) const {
    return c.work.of<LiquidScratch>().liquid.grid.order()[other];
  }
  Index solid_of(Index other) const {
    return c.model.liquid_count + c.work.of<LiquidScratch>().solids_in_liquid.grid.order()[other];
  }
  const LiquidModel& liquid() const { return liquid_of(c.model, particle_of(slot)); }
  bool is_alike(Index other) const {
    return c.model.material[particle_of(other)] == c.model.material[particle_of(slot)];
  }
  Real volume(Index other) const { return c.model.rest_volume[particle_of(other)]; }
  Vec3 position() const {
    const CellSortedPoints& points = c.work.of<LiquidScratch>().liquid;
    return {points.x[slot], points.y[slot], points.z[slot]};
  }
};

/// Calls f(slot, x, mirror) for the liquid particles in reach and for their images, with x pointing
/// to the particle at the place. The mirror is null for particles.
template <class F>
void for_each_liquid(const Neighbourhood& at, F&& f) {
  const StepContext& c = at.c;
  const CellSortedPoints& points = c.work.of<LiquidScratch>().liquid;
  const PairBlock& pairs = c.work.of<LiquidScratch>().liquid_pairs[at.slot / kBlockSize];
  const Vec3 place = at.position();
  const Index in_block = at.slot % kBlockSize;
  for (Index k = pairs.begin[in_block]; k < pairs.begin[in_block + 1]; ++k) {
    const Index slot = pairs.slots[k];
    const Vec3 x = place - Vec3(points.x[slot], points.y[slot], points.z[slot]);
    f(slot, nearest_image(c.model, x), static_cast<const Mirror*>(nullptr));
  }
  if (c.model.walls.empty()) return;
  for_each_image(c.model, at.motion, points, place, at.liquid().support_radius,
                 [&](Index slot, const Vec3& x, const Mirror& mirror) { f(slot, x, &mirror); });
}

/// Calls f(solid particle, x) for the solid particles in reach and their images.
template <class F>
void for_each_solid(const Neighbourhood& at, F&& f) {
  const StepContext& c = at.c;
  if (!has_solids(c.model)) return;
  const CellSortedPoints& solids = c.work.of<LiquidScratch>().solids_in_liquid;
  const PairBlock& near = c.work.of<LiquidScratch>().solids_of_liquid[at.slot / kBlockSize];
  const Vec3 place = at.position();
  const Real support = at.liquid().support_radius;
  const Index in_block = at.slot % kBlockSize;
  for (Index k = near.begin[in_block]; k < near.begin[in_block + 1]; ++k) {
    const Index slot = near.slots[k];
    const Vec3 x = place - Vec3(solids.x[slot], solids.y[slot], solids.z[slot]);
    const Vec3 nearest = nearest_image(c.model, x);
    if (nearest.squaredNorm() < support * support) f(at.solid_of(slot), nearest);
  }
  if (c.model.walls.empty()) return;
  for_each_image(c.model, at.motion, solids, place, support,
                 [&](Index slot, const Vec3& x, const Mirror&) { f(at.solid_of(slot), x); });
}

/// Calls f(place) for each liquid particle.
template <class F>
void for_each_neighbourhood(const StepContext& c, F&& f) {
  const VatMotion motion = motion_of(c);
  for_blocks(c.runner, c.model.liquid_count, [&](std::size_t begin, std::size_t end) {
    for (std::size_t slot = begin; slot < end; ++slot) {
      f(Neighbourhood{c, motion, static_cast<Index>(slot)});
    }
  });
}

/// The normal of a surface at the contact angle with a wall, in the direction of `normal` along the
/// wall. `inwards` is the direction of the wall's normal. Zero if `normal` has no component along
/// the wall.
Vec3 contact_normal(const Vec3& normal, int axis, Real inwards, Real cosine) {
  Vec3 along = normal;
  along[axis] = 0;
  const Real length = along.norm();
  if (!(length > 0)) return Vec3::Zero();
  Vec3 result = std::sqrt(1 - cosine * cosine) / length * along;
  result[axis] = -cosine * inwards;
  return result;
}

Real wall_cosine(const Neighbourhood& at) {
  return at.c.model.wall_cosines[at.c.model.material[at.particle_of(at.slot)]];
}

/// The normal of the image of a particle with `normal`: reflected at the contact normal, so that
/// the surface has the contact normal at the wall.
Vec3 image_normal(const Neighbourhood& at, Vec3 normal, const Mirror& mirror) {
  const Real cosine = wall_cosine(at);
  if (cosine == 0) return mirror.turn(normal);
  const Vec3 place = at.position();
  for (int axis = 0; axis < 3; ++axis) {
    if (!mirror.axes[static_cast<std::size_t>(axis)]) continue;
    const Real inwards = 2 * place[axis] > mirror.twice_plane[axis] ? 1 : -1;
    const Vec3 contact = contact_normal(normal, axis, inwards, cosine);
    if (!contact.isZero(0)) normal = 2 * contact.dot(normal) * contact - normal;
  }
  return normal;
}

/// Interpolates normals near walls to the contact normal.
Vec3 turn_at_walls(const Neighbourhood& at, Vec3 normal) {
  const Model& model = at.c.model;
  const Real cosine = wall_cosine(at);
  if (cosine == 0) return normal;
  for (const int wall : model.walls) {
    const Real q = wall_distance(*model.scene.vat, at.motion, wall, at.position()) /
                   at.liquid().support_radius;
    if (q >= 1) continue;
    const Vec3 contact = contact_normal(normal, wall / 2, wall % 2 == 0 ? 1 : -1, cosine);
    const Real share = 1 - std::max(Real{0}, q);
    const Vec3 sum = share * contact + (1 - share) * normal;
    if (!contact.isZero(0) && !sum.isZero(0)) normal = sum.normalized();
  }
  return normal;
}

SurfaceRecord surface_at(const Neighbourhood& at) {
  const LiquidModel& liquid = at.liquid();
  const SmoothingKernel& kernel = liquid.kernel;
  Vec3 gradient = Vec3::Zero();
  Real sum = at.volume(at.slot) * kernel.value(0);
  for_each_liquid(at, [&](Index other, const Vec3& x, const Mirror*) {
    const Real r = x.norm();
    sum += at.volume(other) * kernel.value(r);
    if (at.is_alike(other)) gradient += (at.volume(other) * kernel.slope_over_r(r)) * x;
  });
  for_each_solid(at, [&](Index solid, const Vec3& x) {
    const Real r = x.norm();
    sum += at.c.model.rest_volume[solid] * kernel.value(r);
    gradient += (at.c.model.rest_volume[solid] * kernel.slope_over_r(r)) * x;
  });
  return {liquid.slope_scale * gradient, std::max(Real{0}, 1 - sum)};
}

/// The kernel-weighted mean of the gradients of the neighbours, as a direction.
Vec3 normal_at(const Neighbourhood& at) {
  const std::vector<SurfaceRecord>& surface = at.c.work.of<SurfaceScratch>().surface;
  const LiquidModel& liquid = at.liquid();
  const Vec3& own = surface[at.slot].gradient;
  if (own.norm() * liquid.support_radius <= kSurfaceThreshold) return Vec3::Zero();
  Vec3 sum = at.volume(at.slot) * liquid.kernel.value(0) * own;
  for_each_liquid(at, [&](Index other, const Vec3& x, const Mirror* mirror) {
    if (!at.is_alike(other)) return;
    const Vec3& there = surface[other].gradient;
    sum += (at.volume(other) * liquid.kernel.value(x.norm())) *
           (mirror == nullptr ? there : mirror->turn(there));
  });
  const Real length = sum.norm();
  return length > 0 ? turn_at_walls(at, sum / length) : Vec3(Vec3::Zero());
}

/// The curvature of the surface, from the curvature of the parallel surface of the particles below
/// it.
Real lift_to_surface(const Neighbourhood& at, Real curvature) {
  const int dimensions = at.c.model.scene.dimensions;
  const Real share = kSurfaceDepth / (dimensions - 1) + kSurfaceBulge;
  const Real h = at.liquid().support_radius;
  return curvature / (1 + std::max(Real{-0.5}, share * h * curvature));
}

/// -div n over particles at the surface and their images.
Real curvature_at(const Neighbourhood& at) {
  const std::vector<Vec3>& normals = at.c.work.of<SurfaceScratch>().surface_normals;
  const SmoothingKernel& kernel = at.liquid().kernel;
  const Vec3& own = normals[at.slot];
  Real divergence = 0;
  Real weight = at.volume(at.slot) * kernel.value(0);
  for_each_liquid(at, [&](Index other, const Vec3& x, const Mirror* mirror) {
    if (normals[other].isZero(0) || !at.is_alike(other)) return;
    const Real r = x.norm();
    const Vec3 there =
        mirror == nullptr ? normals[other] : image_normal(at, normals[other], *mirror);
    const Vec3 change = there - own;
    divergence += at.volume(other) * kernel.slope_over_r(r) * change.dot(x);
    weight += at.volume(other) * kernel.value(r);
  });
  return lift_to_surface(at, -divergence / weight);
}

/// Half the derivative of the cohesion energy by s_i [Pa].
Real cohesion_of(const Neighbourhood& at, Index slot) {
  const LiquidModel& liquid = liquid_of(at.c.model, at.particle_of(slot));
  return 2 * kCohesion * liquid.surface_tension / liquid.support_radius *
         at.c.work.of<SurfaceScratch>().surface[slot].kernel_deficiency;
}

/// The force of cohesion, divided by the particle's volume.
Vec3 cohesion_at(const Neighbourhood& at) {
  const LiquidModel& liquid = at.liquid();
  const Real own = cohesion_of(at, at.slot);
  Vec3 sum = Vec3::Zero();
  for_each_liquid(at, [&](Index other, const Vec3& x, const Mirror*) {
    const Real both = own + cohesion_of(at, other);
    if (both > 0) sum += (at.volume(other) * both * liquid.kernel.slope_over_r(x.norm())) * x;
  });
  return liquid.slope_scale * sum;
}

}  // namespace

void find_surface(StepContext& c) {
  SurfaceScratch& surface_buffers = c.work.of<SurfaceScratch>();
  VAT_CHECK(c.work.of<LiquidScratch>().liquid.grid.order().size() == c.model.liquid_count);
  surface_buffers.surface.resize(c.model.liquid_count);
  for_each_neighbourhood(
      c, [&](const Neighbourhood& at) { surface_buffers.surface[at.slot] = surface_at(at); });
}

void find_surface_normals(StepContext& c) {
  SurfaceScratch& surface_buffers = c.work.of<SurfaceScratch>();
  VAT_CHECK(surface_buffers.surface.size() == c.model.liquid_count);
  surface_buffers.surface_normals.resize(c.model.liquid_count);
  for_each_neighbourhood(c, [&](const Neighbourhood& at) {
    surface_buffers.surface_normals[at.slot] = normal_at(at);
  });
}

namespace {

/// The force of curvature, divided by the particle's volume.
Vec3 squeeze_at(const Neighbourhood& at) {
  SurfaceScratch& surface_buffers = at.c.work.of<SurfaceScratch>();
  const Vec3& normal = surface_buffers.surface_normals[at.slot];
  if (normal.isZero(0)) return Vec3::Zero();
  const Real delta = 2 * surface_buffers.surface[at.slot].gradient.norm();
  return (at.liquid().surface_tension * curvature_at(at) * delta) * normal;
}

/// The weight of the particle in corrections: sigma times its part of the surface.
Real share_of(const Neighbourhood& at) {
  SurfaceScratch& surface_buffers = at.c.work.of<SurfaceScratch>();
  if (surface_buffers.surface_normals[at.slot].isZero(0)) return 0;
  return at.liquid().surface_tension * at.volume(at.slot) *
         surface_buffers.surface[at.slot].gradient.norm();
}

SurfaceSum sum_surface(StepContext& c, const std::vector<Vec3>& force) {
  std::vector<SurfaceSum>& sums = c.work.of<SurfaceScratch>().surface_sums;
  sums.assign(block_count(force.size()), {});
  for_each_neighbourhood(c, [&](const Neighbourhood& at) {
    SurfaceSum& sum = sums[at.slot / kBlockSize];
    const Real share = share_of(at);
    const Vec3 x = at.position();
    sum.force += force[at.slot];
    sum.torque += x.cross(force[at.slot]);
    sum.share += share;
    sum.moment += share * x;
    sum.second_moment += share * x * x.transpose();
  });
  SurfaceSum all;
  for (const SurfaceSum& sum : sums) all += sum;
  return all;
}

/// Makes the sums of the curvature forces, by slot, and of their torques zero. Subtracts the
/// remainder as a rigid motion of the surface, weighted with sigma times area.
void balance(StepContext& c, std::vector<Vec3>& force) {
  const SurfaceSum all = sum_surface(c, force);
  if (!(all.share > 0)) return;
  const Vec3 center = all.moment / all.share;
  const Vec3 excess = all.force / all.share;
  Vec3 turn = Vec3::Zero();
  if (!c.model.periodic.any()) {
    const Mat3 second = all.second_moment - all.share * center * center.transpose();
    const Mat3 inertia = second.trace() * Mat3::Identity() - second;
    const Eigen::LDLT<Mat3> solver(inertia);
    // For points on a line, there is no torque along it.
    const bool is_line = !(solver.vectorD().minCoeff() > 1e-9 * inertia.trace());
    if (!is_line) turn = solver.solve(all.torque - center.cross(all.force));
  }
  for_each_neighbourhood(c, [&](const Neighbourhood& at) {
    force[at.slot] -= share_of(at) * (excess + turn.cross(at.position() - center));
  });
}

}  // namespace

void add_surface_tension(StepContext& c) {
  std::vector<Vec3>& squeeze = c.work.of<SurfaceScratch>().surface_forces;
  VAT_CHECK(c.forces.particle.size() == c.model.particle_count);
  squeeze.resize(c.model.liquid_count);
  for_each_neighbourhood(
      c, [&](const Neighbourhood& at) { squeeze[at.slot] = at.volume(at.slot) * squeeze_at(at); });
  if (c.model.walls.empty() && !has_solids(c.model)) balance(c, squeeze);
  for_each_neighbourhood(c, [&](const Neighbourhood& at) {
    const Vec3 pull = cohesion_at(at);
    c.forces.particle[at.particle_of(at.slot)] += squeeze[at.slot] + at.volume(at.slot) * pull;
  });
}

}  // namespace vat
