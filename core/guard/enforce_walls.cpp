#include "core/guard/enforce_walls.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <limits>

#include "core/laws/vat_motion.h"
#include "core/state/rigid_motion.h"
#include "core/support/check.h"

namespace vat {
namespace {

/// The walls of the model at the end of a step.
struct Walls {
  const Model& model;
  VatMotion motion;

  Real distance(int wall, const Vec3& p) const {
    return wall_distance(*model.scene.vat, motion, wall, p);
  }
};

constexpr Real inward(int wall) {
  return wall % 2 == 0 ? 1 : -1;
}

/// Rounding error of positions at the walls across an axis [m].
Real round_off(const Walls& walls, int axis) {
  const Vat& vat = *walls.model.scene.vat;
  const Real offset = std::abs(walls.motion.offset[axis]);
  const Real place = std::max(std::abs(vat.min[axis]), std::abs(vat.max[axis]));
  return std::numeric_limits<Real>::epsilon() * (place + offset);
}

/// The coordinate of the wall, or the first one inside it that counts as inside.
Real plane_of(const Walls& walls, int wall, Vec3 p) {
  const Vat& vat = *walls.model.scene.vat;
  const int axis = wall / 2;
  const Real plane = (wall % 2 == 0 ? vat.min : vat.max)[axis] + walls.motion.offset[axis];
  p[axis] = plane;
  for (Real inset = round_off(walls, axis); walls.distance(wall, p) < 0; inset *= 2) {
    p[axis] = plane + inward(wall) * inset;
  }
  return p[axis];
}

/// A box inside the walls by more than the rounding error, unbounded without walls. Positions in it
/// need no exact test.
struct ClearBox {
  explicit ClearBox(const Walls& walls) {
    constexpr Real kUnits = 8;
    const Vat& vat = *walls.model.scene.vat;
    for (const int wall : walls.model.walls) {
      const int axis = wall / 2;
      const Real inset = kUnits * round_off(walls, axis);
      const Real offset = walls.motion.offset[axis];
      if (wall % 2 == 0) {
        min[axis] = vat.min[axis] + offset + inset;
      } else {
        max[axis] = vat.max[axis] + offset - inset;
      }
    }
  }
  bool has(const Vec3& p) const {
    return p.x() >= min.x() && p.y() >= min.y() && p.z() >= min.z() && p.x() <= max.x() &&
           p.y() <= max.y() && p.z() <= max.z();
  }

  Vec3 min = Vec3::Constant(-std::numeric_limits<Real>::infinity());
  Vec3 max = Vec3::Constant(std::numeric_limits<Real>::infinity());
};

/// Returns a particle to the inside. Mirror walls reflect it: on the plane it would stay there,
/// because its own image would not repel it.
bool move_particle_inside(const Walls& walls, bool is_mirrored, Vec3& position, Vec3& velocity) {
  const bool bounces = is_mirrored && !walls.model.is_incompressible;
  bool is_stopped = false;
  for (const int wall : walls.model.walls) {
    const Real distance = walls.distance(wall, position);
    if (!(distance < 0)) continue;
    is_stopped = true;
    const int axis = wall / 2;
    const Real speed = walls.motion.velocity[axis];
    const bool leaves = inward(wall) * (velocity[axis] - speed) < 0;
    position[axis] = plane_of(walls, wall, position);
    if (leaves) velocity[axis] = bounces ? 2 * speed - velocity[axis] : speed;
    if (!is_mirrored) continue;
    const Vec3 image = position - distance * wall_normal(wall);
    const bool fits = std::ranges::none_of(
        walls.model.walls, [&](int other) { return walls.distance(other, image) < 0; });
    if (fits) position = image;
  }
  return is_stopped;
}

/// The particles of a rigid body, seen from one wall.
struct Reach {
  Real distance = std::numeric_limits<Real>::infinity();  ///< minimum [m]
  Real depth = 0;           ///< sum over particles beyond the wall [m]
  Vec3 arm = Vec3::Zero();  ///< sum of depth times arm [m^2]
};
using Reaches = std::array<Reach, kWallCount>;

Reaches find_reaches(const Walls& walls, const RigidModel& rigid, const Vec3& center,
                     const Configuration& at) {
  Reaches reaches;
  for (Index i = rigid.particles.begin; i < rigid.particles.end; ++i) {
    for (const int wall : walls.model.walls) {
      const Real distance = walls.distance(wall, at.position[i]);
      Reach& reach = reaches[static_cast<std::size_t>(wall)];
      reach.distance = std::min(reach.distance, distance);
      if (!(distance < 0)) continue;
      reach.depth -= distance;
      reach.arm -= distance * (at.position[i] - center);
    }
  }
  return reaches;
}

bool is_inside(const Reaches& reaches) {
  return std::ranges::none_of(reaches, [](const Reach& reach) { return reach.distance < 0; });
}

bool fits(const Walls& walls, const Reaches& reaches) {
  for (std::size_t low = 0; low < kWallCount; low += 2) {
    const Real slack = reaches[low].distance + reaches[low + 1].distance;
    if (slack < -4 * round_off(walls, static_cast<int>(low) / 2)) return false;
  }
  return true;
}

/// Removes the outward velocity of the body's point at `arm` by an impulse along the normal.
void stop_point(const Walls& walls, int wall, const RigidModel& rigid, const Vec3& arm,
                RigidState& state) {
  const Vec3 normal = wall_normal(wall);
  const Vec3 omega = angular_velocity(rigid, state.orientation, state.angular_momentum);
  const Vec3 velocity =
      rigid.inverse_mass * state.momentum + omega.cross(arm) - walls.motion.velocity;
  const Real speed = velocity.dot(normal);
  if (!(speed < 0)) return;
  const Vec3 lever = arm.cross(normal);
  const Real mobility =
      rigid.inverse_mass + lever.dot(angular_velocity(rigid, state.orientation, lever));
  const Real impulse = -speed / mobility;
  state.momentum += impulse * normal;
  state.angular_momentum += impulse * lever;
}

/// Returns whether the box of the body's particles is inside every wall by more than the rounding
/// error.
bool is_clear(const Walls& walls, const RigidState& state, const Vec3& half_sizes) {
  constexpr Real kMargin = 1.001;
  const Vec3 reach =
      state.orientation.normalized().toRotationMatrix().cwiseAbs() * (kMargin * half_sizes);
  return std::ranges::all_of(walls.model.walls, [&](int wall) {
    return walls.distance(wall, state.center_of_mass) > reach[wall / 2];
  });
}

bool move_body_inside(const Walls& walls, const RigidModel& rigid, const Quat& earlier_orientation,
                      RigidState& state, Configuration& now) {
  // The first round suffices, except in a corner that is narrow for the body. The others correct
  // its rounding errors.
  constexpr int kRounds = 8;
  for (int round = 0; round < kRounds; ++round) {
    pose_rigid_body(walls.model, rigid, state, now);
    Reaches reaches = find_reaches(walls, rigid, state.center_of_mass, now);
    if (is_inside(reaches)) return round > 0;
    if (!fits(walls, reaches)) {
      state.orientation = earlier_orientation;
      state.angular_momentum.setZero();
      pose_rigid_body(walls.model, rigid, state, now);
      reaches = find_reaches(walls, rigid, state.center_of_mass, now);
    }
    const Vec3 center = state.center_of_mass;
    for (const int wall : walls.model.walls) {
      const Reach& reach = reaches[static_cast<std::size_t>(wall)];
      if (!(reach.distance < 0)) continue;
      const int axis = wall / 2;
      const Real unit =
          round_off(walls, axis) + std::numeric_limits<Real>::epsilon() * std::abs(center[axis]);
      state.center_of_mass[axis] += inward(wall) * (round * unit - reach.distance);
      stop_point(walls, wall, rigid, reach.arm / reach.depth, state);
    }
  }
  pose_rigid_body(walls.model, rigid, state, now);
  return true;
}

}  // namespace

std::uint64_t enforce_walls_on_particles(const Model& model, Real time, std::size_t count,
                                         TaskRunner* runner, Configuration& now) {
  if (model.walls.empty()) return 0;
  VAT_CHECK(count <= now.position.size() && count <= model.free_count);
  const Walls walls{model, vat_motion(*model.scene.vat, time)};
  const ClearBox clear(walls);
  std::atomic<std::uint64_t> stops = 0;
  for_blocks(runner, count, [&](std::size_t begin, std::size_t stop) {
    for (std::size_t i = begin; i < stop; ++i) {
      if (clear.has(now.position[i]) || model.inverse_mass[i] == 0) continue;
      const bool is_mirrored = model.is_coupled && i < model.liquid_count;
      if (move_particle_inside(walls, is_mirrored, now.position[i], now.velocity[i])) {
        stops.fetch_add(1, std::memory_order_relaxed);
      }
    }
  });
  return stops;
}

void hold_liquid_inside(const ForceModel& f, Real time, Configuration& now) {
  const std::uint64_t stops =
      enforce_walls_on_particles(f.model, time, f.model.liquid_count, f.runner, now);
  if (f.report != nullptr) f.report->wall_stops += stops;
}

std::uint64_t enforce_walls(const Model& model, const GuardBounds& bounds, const StepEnd& end,
                            const Configuration& before, TaskRunner* runner, Configuration& now) {
  if (model.walls.empty()) return 0;
  VAT_CHECK(bounds.half_sizes.size() == model.rigid_bodies.size());
  const Walls walls{model, vat_motion(*model.scene.vat, end.time)};
  std::uint64_t stops = enforce_walls_on_particles(model, end.time, model.free_count, runner, now);
  for (std::size_t b = 0; b < model.rigid_bodies.size(); ++b) {
    const RigidModel& rigid = model.rigid_bodies[b];
    RigidState& state = now.rigid[b];
    if (rigid.is_held(end.step) || rigid.axle || is_clear(walls, state, bounds.half_sizes[b])) {
      continue;
    }
    if (move_body_inside(walls, rigid, before.rigid[b].orientation, state, now)) ++stops;
  }
  return stops;
}

}  // namespace vat
