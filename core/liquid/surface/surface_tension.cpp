#include "core/liquid/surface/surface_tension.h"

#include <Eigen/Cholesky>
#include <algorithm>

#include "core/laws/surface_tension.h"
#include "core/liquid/pairs/coupled_pairs.h"
#include "core/liquid/pairs/liquid_pairs.h"
#include "core/liquid/surface/scratch.h"
#include "core/support/check.h"

namespace vat {
namespace {

/// A liquid particle.
struct SurfacePoint {
  const StepContext& c;
  Index slot;

  const SurfaceScratch& surface() const { return c.work.of<SurfaceScratch>(); }
  Index particle() const { return c.work.of<LiquidScratch>().liquid.grid.order()[slot]; }
  Index material() const { return c.model.material[particle()]; }
  const LiquidModel& liquid() const { return liquid_of(c.model, particle()); }
  Real volume() const { return c.model.rest_volume[particle()]; }
  Vec3 position() const {
    const CellSortedPoints& points = c.work.of<LiquidScratch>().liquid;
    return {points.x[slot], points.y[slot], points.z[slot]};
  }
  const Vec3& normal() const { return surface().surface_normals[slot]; }
  /// |g| [1/m]
  Real steepness() const { return surface().surface[slot].gradient.norm(); }
  bool is_at_surface() const { return steepness() * liquid().support_radius > kSurfaceThreshold; }
};

/// Calls f(point) for each liquid particle.
template <class F>
void for_each_point(const StepContext& c, F&& f) {
  for_blocks(c.runner, c.model.liquid_count, [&](std::size_t begin, std::size_t end) {
    for (std::size_t slot = begin; slot < end; ++slot) {
      f(SurfacePoint{c, static_cast<Index>(slot)});
    }
  });
}

/// Calls f(material) for each material of the liquid bodies.
template <class F>
void for_each_liquid(const Model& model, F&& f) {
  if (!has_several_liquids(model)) {
    f(model.material[0]);
    return;
  }
  for (Index material = 0; material < model.liquids.size(); ++material) {
    if (model.liquids[material]) f(material);
  }
}

/// Sets the motion of each liquid particle to a vector, and that of its images to
/// image_vector(image, vector).
template <class Vector, class ImageVector>
void set_vectors(StepContext& c, Vector&& vector, ImageVector&& image_vector) {
  c.work.of<LiquidScratch>().sources.set_motions(
      c.runner, [&](std::size_t s) { return motion_of(0, vector(s)); },
      [](std::size_t) { return PairMotion{}; },
      [&](const PairImage& image, const PairMotion& source) {
        if (image.source >= c.model.liquid_count) return PairMotion{};
        return motion_of(0, image_vector(image, Vec3(source.vx, source.vy, source.vz)));
      });
}

/// Calls f(point, sums) for the liquid particles with takes(point). The sources are the charges.
template <std::size_t width, class Takes, class F>
void sum_charges(const StepContext& c, PairSums::Function sum, Takes&& takes, F&& f) {
  c.work.of<LiquidScratch>().liquid_clusters.for_some_sums<width>(
      c.runner, charged_pair_inputs(c), sum,
      [&](const TargetCluster& cluster) {
        for (Index slot = cluster.begin; slot < cluster.end; ++slot) {
          if (takes(SurfacePoint{c, slot})) return true;
        }
        return false;
      },
      [&](const TargetCluster&, Index slot, const Real* sums) {
        if (const SurfacePoint point{c, slot}; takes(point)) f(point, sums);
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

/// The normal of the image of a particle with `normal`: reflected at the contact normal, so that
/// the surface has the contact normal at the wall.
Vec3 image_normal(const StepContext& c, const PairImage& image, Vec3 normal) {
  LiquidScratch& buffers = c.work.of<LiquidScratch>();
  const Index particle = buffers.liquid.grid.order()[image.source];
  const Real cosine = c.model.wall_cosines[c.model.material[particle]];
  if (cosine == 0) return image.turn(normal);
  const Vec3 place = buffers.sources.place(image.source);
  const Mirror mirror = image.mirror();
  for (int axis = 0; axis < 3; ++axis) {
    if (!mirror.axes[static_cast<std::size_t>(axis)]) continue;
    const Real inwards = 2 * place[axis] > mirror.twice_plane[axis] ? 1 : -1;
    const Vec3 contact = contact_normal(normal, axis, inwards, cosine);
    if (!contact.isZero(0)) normal = 2 * contact.dot(normal) * contact - normal;
  }
  return normal;
}

/// Interpolates normals near walls to the contact normal.
Vec3 turn_at_walls(const SurfacePoint& at, const VatMotion& motion, Vec3 normal) {
  const Model& model = at.c.model;
  const Real cosine = model.wall_cosines[at.material()];
  if (cosine == 0) return normal;
  for (const int wall : model.walls) {
    const Real q =
        wall_distance(*model.scene.vat, motion, wall, at.position()) / at.liquid().support_radius;
    if (q >= 1) continue;
    const Vec3 contact = contact_normal(normal, wall / 2, wall % 2 == 0 ? 1 : -1, cosine);
    const Real share = 1 - std::max(Real{0}, q);
    const Vec3 sum = share * contact + (1 - share) * normal;
    if (!contact.isZero(0) && !sum.isZero(0)) normal = sum.normalized();
  }
  return normal;
}

/// The curvature of the surface, from the curvature of the parallel surface of the particles below
/// it.
Real lift_to_surface(const SurfacePoint& at, Real curvature) {
  const int dimensions = at.c.model.scene.dimensions;
  const Real share = kSurfaceDepth / (dimensions - 1) + kSurfaceBulge;
  const Real h = at.liquid().support_radius;
  return curvature / (1 + std::max(Real{-0.5}, share * h * curvature));
}

/// Subtracts the parts of other liquids from the gradients.
void remove_other_liquids(StepContext& c) {
  LiquidScratch& buffers = c.work.of<LiquidScratch>();
  std::vector<SurfaceRecord>& surface = c.work.of<SurfaceScratch>().surface;
  const std::span<const Index> order = buffers.liquid.grid.order();
  for_each_liquid(c.model, [&](Index material) {
    const Real slope = slope_factor(c.model, *c.model.liquids[material]);
    buffers.sources.set_charges(
        c.runner, [&](std::size_t s) -> Real { return c.model.material[order[s]] != material; });
    sum_charges<3>(
        c, pair_sums_of(c).gradient,
        [&](const SurfacePoint& point) { return point.material() == material; },
        [&](const SurfacePoint& point, const Real* sums) {
          surface[point.slot].gradient -= slope * Eigen::Map<const Vec3>(sums);
        });
  });
}

}  // namespace

SurfaceBalance balance_of(const SurfaceSum& sum, bool balances_torque) {
  SurfaceBalance balance;
  if (!(sum.share > 0)) return balance;
  balance.center = sum.moment / sum.share;
  balance.excess = sum.force / sum.share;
  if (!balances_torque) return balance;
  const Vec3& center = balance.center;
  const Mat3 second = sum.second_moment - sum.share * center * center.transpose();
  const Mat3 inertia = second.trace() * Mat3::Identity() - second;
  const Eigen::LDLT<Mat3> solver(inertia);
  // For points on a line, there is no torque along it.
  const bool is_line = !(solver.vectorD().minCoeff() > 1e-9 * inertia.trace());
  if (!is_line) balance.turn = solver.solve(sum.torque - center.cross(sum.force));
  return balance;
}

void find_surface(StepContext& c) {
  LiquidScratch& buffers = c.work.of<LiquidScratch>();
  std::vector<SurfaceRecord>& surface = c.work.of<SurfaceScratch>().surface;
  const Model& model = c.model;
  VAT_CHECK(buffers.liquid.grid.order().size() == model.liquid_count);
  if (has_solids(model)) buffers.sources.set_weights(c, {});
  const auto scale =
      by_material(model, [&](const LiquidModel& liquid) { return scale_factor(model, liquid); });
  const auto slope =
      by_material(model, [&](const LiquidModel& liquid) { return slope_factor(model, liquid); });
  surface.resize(model.liquid_count);
  buffers.liquid_clusters.for_each_sum<kVolumeSums>(
      c.runner, pair_inputs(c), pair_sums_of(c).volume,
      [&](const TargetCluster&, Index slot, const Real* sums) {
        const Index material = SurfacePoint{c, slot}.material();
        surface[slot] = {slope[material] * Eigen::Map<const Vec3>(sums + 1),
                         std::max(Real{0}, 1 - scale[material] * sums[0])};
      });
  if (has_several_liquids(model)) remove_other_liquids(c);
}

// The kernel-weighted mean of the gradients of the neighbours, as a direction.
void find_surface_normals(StepContext& c) {
  LiquidScratch& buffers = c.work.of<LiquidScratch>();
  SurfaceScratch& own = c.work.of<SurfaceScratch>();
  const std::span<const Index> order = buffers.liquid.grid.order();
  const VatMotion motion = motion_of(c);
  VAT_CHECK(own.surface.size() == c.model.liquid_count);
  own.surface_normals.assign(c.model.liquid_count, Vec3::Zero());
  set_vectors(
      c, [&](std::size_t s) { return own.surface[s].gradient; },
      [](const PairImage& image, const Vec3& gradient) { return image.turn(gradient); });
  for_each_liquid(c.model, [&](Index material) {
    buffers.sources.set_charges(
        c.runner, [&](std::size_t s) -> Real { return c.model.material[order[s]] == material; });
    sum_charges<3>(
        c, pair_sums_of(c).blend,
        [&](const SurfacePoint& point) {
          return point.material() == material && point.is_at_surface();
        },
        [&](const SurfacePoint& point, const Real* sums) {
          const Eigen::Map<const Vec3> sum(sums);
          if (const Real length = sum.norm(); length > 0) {
            own.surface_normals[point.slot] = turn_at_walls(point, motion, sum / length);
          }
        });
  });
}

namespace {

/// The weight of the particle in corrections: sigma times its part of the surface.
Real share_of(const SurfacePoint& at) {
  if (at.normal().isZero(0)) return 0;
  return at.liquid().surface_tension * at.volume() * at.steepness();
}

SurfaceSum sum_surface(StepContext& c, const std::vector<Vec3>& force) {
  std::vector<SurfaceSum>& sums = c.work.of<SurfaceScratch>().surface_sums;
  sums.assign(block_count(force.size()), {});
  for_each_point(c, [&](const SurfacePoint& at) {
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
  const SurfaceBalance motion = balance_of(all, !c.model.periodic.any());
  for_each_point(c, [&](const SurfacePoint& at) {
    force[at.slot] -=
        share_of(at) * (motion.excess + motion.turn.cross(at.position() - motion.center));
  });
}

/// Sets the curvature forces. The curvature is -div n over particles at the surface and their
/// images.
void find_curvature_forces(StepContext& c, std::vector<Vec3>& force) {
  LiquidScratch& buffers = c.work.of<LiquidScratch>();
  const std::vector<Vec3>& normals = c.work.of<SurfaceScratch>().surface_normals;
  const std::span<const Index> order = buffers.liquid.grid.order();
  force.assign(c.model.liquid_count, Vec3::Zero());
  set_vectors(
      c, [&](std::size_t s) { return normals[s]; },
      [&](const PairImage& image, const Vec3& normal) { return image_normal(c, image, normal); });
  for_each_liquid(c.model, [&](Index material) {
    const LiquidModel& liquid = *c.model.liquids[material];
    const Real ratio =
        slope_factor(c.model, liquid) / liquid.slope_scale / scale_factor(c.model, liquid);
    buffers.sources.set_charges(c.runner, [&](std::size_t s) -> Real {
      return c.model.material[order[s]] == material && !normals[s].isZero(0);
    });
    sum_charges<kSpreadSums>(
        c, pair_sums_of(c).spread,
        [&](const SurfacePoint& point) {
          return point.material() == material && !point.normal().isZero(0);
        },
        [&](const SurfacePoint& point, const Real* sums) {
          const Real curvature = lift_to_surface(point, ratio * sums[0] / sums[1]);
          force[point.slot] =
              (point.volume() * liquid.surface_tension * curvature * 2 * point.steepness()) *
              point.normal();
        });
  });
}

/// Half the derivative of the cohesion energy by s_i [Pa].
Real cohesion_of(const SurfacePoint& at) {
  const LiquidModel& liquid = at.liquid();
  return 2 * kCohesion * liquid.surface_tension / liquid.support_radius *
         at.surface().surface[at.slot].kernel_deficiency;
}

/// Adds the attraction between particles at the surface.
void add_surface_cohesion(StepContext& c) {
  LiquidScratch& buffers = c.work.of<LiquidScratch>();
  buffers.sources.set_motions(
      c.runner,
      [&](std::size_t s) {
        return motion_of(cohesion_of(SurfacePoint{c, static_cast<Index>(s)}), Vec3::Zero());
      },
      [](std::size_t) { return PairMotion{}; },
      [](const PairImage&, const PairMotion& source) { return source; });
  buffers.sources.set_charges(c.runner, [](std::size_t) { return Real{1}; });
  const auto slope = by_material(
      c.model, [&](const LiquidModel& liquid) { return slope_factor(c.model, liquid); });
  buffers.liquid_clusters.for_each_sum<3>(
      c.runner, charged_pair_inputs(c), pair_sums_of(c).pressure,
      [&](const TargetCluster&, Index slot, const Real* sums) {
        const SurfacePoint point{c, slot};
        c.forces.particle[point.particle()] -=
            (point.volume() * slope[point.material()]) * Eigen::Map<const Vec3>(sums);
      });
}

}  // namespace

void add_surface_tension(StepContext& c) {
  std::vector<Vec3>& force = c.work.of<SurfaceScratch>().surface_forces;
  VAT_CHECK(c.forces.particle.size() == c.model.particle_count);
  find_curvature_forces(c, force);
  if (c.model.walls.empty() && !has_solids(c.model)) balance(c, force);
  for_each_point(c, [&](const SurfacePoint& point) {
    c.forces.particle[point.particle()] += force[point.slot];
  });
  add_surface_cohesion(c);
}

}  // namespace vat
