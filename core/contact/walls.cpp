#include "core/contact/walls.h"

#include <algorithm>
#include <limits>

#include "core/contact/contact_rules.h"
#include "core/contact/restitution.h"
#include "core/contact/scratch.h"
#include "core/laws/connection.h"
#include "core/laws/lennard_jones.h"
#include "core/stage/context.h"
#include "core/state/state.h"
#include "core/support/check.h"

namespace vat {
namespace {

/// The walls of a model at one time.
class WallPlanes {
 public:
  WallPlanes(const Model& model, const VatMotion& motion) : offset_(motion.offset) {
    for (const int wall : model.walls) {
      const int axis = wall / 2;
      (wall % 2 == 0 ? min_ : max_)[axis] =
          (wall % 2 == 0 ? model.scene.vat->min : model.scene.vat->max)[axis];
    }
  }

  /// The minimum of wall_distance() over the walls [m].
  Real nearest(const Vec3& p) const {
    const Vec3 x = p - offset_;
    const Real along_x = std::min(x.x() - min_.x(), max_.x() - x.x());
    const Real along_y = std::min(x.y() - min_.y(), max_.y() - x.y());
    const Real along_z = std::min(x.z() - min_.z(), max_.z() - x.z());
    return std::min(std::min(along_x, along_y), along_z);
  }

 private:
  Vec3 offset_;
  Vec3 min_ = Vec3::Constant(-std::numeric_limits<Real>::infinity());
  Vec3 max_ = Vec3::Constant(std::numeric_limits<Real>::infinity());
};

/// The sum over the walls that act on one particle.
struct WallForce {
  Vec3 force = Vec3::Zero();   ///< [N]
  Vec3 torque = Vec3::Zero();  ///< of friction, about the particle's centre [N m]
  int count = 0;               ///< number of walls that exert a force
  Real stiffness = 0;          ///< maximum [N/m]
  Real damping = 0;            ///< maximum over the dashpots [N s/m]
};

void add_layer(const ContactLaw& law, int wall, Real threshold, Real distance, WallForce& sum) {
  const Real width = threshold * law.layer / (1 + law.layer);
  sum.force += layer_push(law.stiffness, width, threshold, distance) * wall_normal(wall);
  sum.stiffness =
      std::max(sum.stiffness, greatest_layer_slope(law.stiffness, width, threshold, distance));
  ++sum.count;
}

/// `damping_at(wall)`: damping of the dashpot [N s/m]. `kept` collects the dampers; it may be null.
template <bool has_friction, class Damping>
WallForce sum_walls(const Model& model, const VatMotion& motion, const Configuration& at,
                    const std::vector<Vec3>& spins, Index i, Damping&& damping_at,
                    DamperBlock* kept) {
  const ContactLaw& law = model.wall_laws[model.material[i]];
  const Real threshold = law.wall_threshold(model.radius[i]);
  WallForce sum;
  for (const int wall : model.walls) {
    const Real distance = wall_distance(*model.scene.vat, motion, wall, at.position[i]);
    if (distance >= threshold) continue;
    if (law.layer > 0) {
      add_layer(law, wall, threshold, distance, sum);
      continue;
    }
    const int axis = wall / 2;
    const Real side = wall % 2 == 0 ? 1 : -1;
    const Real speed = side * (at.velocity[i][axis] - motion.velocity[axis]);
    const Real damping = damping_at(wall);
    const Real push = connection_push(law.stiffness, damping, threshold, distance, speed);
    if (push <= 0) continue;
    sum.force[axis] += side * push;
    ++sum.count;
    sum.stiffness = law.stiffness;
    sum.damping = std::max(sum.damping, damping);
    if (kept != nullptr && damping > 0) {
      kept->dampers.push_back({kNoParticle, damping, wall_normal(wall)});
    }
    if constexpr (has_friction) {
      const Friction friction = wall_friction(model, i);
      if (!friction.acts()) continue;
      const Vec3 arm = wall_arm(model, i, wall, distance);
      const Vec3 slip = wall_slip(*model.scene.vat, motion, wall,
                                  at.velocity[i] + turning_velocity(model, spins, i, arm));
      const Real drag = friction.drag(push, slip);
      const Vec3 friction_force = drag * slip;
      sum.force -= friction_force;
      sum.torque -= arm.cross(friction_force);
      if (kept != nullptr) {
        kept->friction_dampers.push_back({kNoParticle, drag, wall_normal(wall), arm, Vec3::Zero()});
      }
    }
  }
  return sum;
}

template <bool has_friction>
void add_block(StepContext& c, const VatMotion& motion, std::size_t begin, std::size_t end,
               DamperBlock* kept) {
  ContactForceScratch& contact_buffers = c.work.of<ContactForceScratch>();
  const ContactMobility mobilities{c.model, c.work, c.configuration, c.step};
  const WallPlanes planes(c.model, motion);
  for (std::size_t k = begin; k < end; ++k) {
    const auto i = static_cast<Index>(k);
    const ContactLaw& law = c.model.wall_laws[c.model.material[i]];
    if (planes.nearest(c.configuration.position[i]) >= law.wall_threshold(c.model.radius[i])) {
      continue;
    }
    const WallForce sum = sum_walls<has_friction>(
        c.model, motion, c.configuration, contact_buffers.spins, i,
        [&](int wall) { return mobilities.wall_damping(i, wall_normal(wall)); }, kept);
    if (sum.count == 0) continue;
    if (kept != nullptr) kept->close(i);
    c.forces.particle[i] += sum.force;
    if constexpr (has_friction) c.forces.friction_torque[i] += sum.torque;
    contact_buffers.contact_loads[i].stiffness += sum.stiffness;
    Real damping = sum.damping;
    if constexpr (has_friction) {  // walls are at right angles: each drags along the others'
                                   // normals
      const Real sticking = wall_friction(c.model, i).sticking;
      damping = std::max(damping, sticking) + (sum.count - 1) * sticking;
    }
    contact_buffers.contact_loads[i].damping += damping;
  }
}

}  // namespace

Vec3 wall_slip(const Vat& vat, const VatMotion& motion, int wall, const Vec3& velocity) {
  Vec3 slip = velocity - motion.velocity - vat.walls[static_cast<std::size_t>(wall)].velocity;
  slip[wall / 2] = 0;
  return slip;
}

ContactForce wall_force(const Model& model, const VatMotion& motion, const Configuration& at,
                        const std::vector<Vec3>& spins, Index i) {
  const auto damping = [&](int) { return model.wall_laws[model.material[i]].damping; };
  const WallForce sum = model.has_friction
                            ? sum_walls<true>(model, motion, at, spins, i, damping, nullptr)
                            : sum_walls<false>(model, motion, at, spins, i, damping, nullptr);
  return {sum.force, sum.torque};
}

Vec3 wall_arm(const Model& model, Index i, int wall, Real distance) {
  return i < model.free_count ? Vec3(Vec3::Zero()) : Vec3(-distance * wall_normal(wall));
}

void add_wall_forces(StepContext& c) {
  ContactForceScratch& contact_buffers = c.work.of<ContactForceScratch>();
  const VatMotion motion = vat_motion(*c.model.scene.vat, c.time);
  VAT_CHECK(c.forces.particle.size() == c.model.particle_count && c.model.scene.vat);
  contact_buffers.contact_loads.resize(c.model.particle_count);
  if (c.work.keep_dampers) {
    contact_buffers.wall_dampers.resize(block_count(c.model.particle_count));
  }
  for_blocks(c.runner, c.model.particle_count, [&](std::size_t begin, std::size_t end) {
    // Coupled liquids feel walls by their pressure.
    DamperBlock* const kept =
        c.work.keep_dampers ? &contact_buffers.wall_dampers[begin / kBlockSize] : nullptr;
    if (kept != nullptr) kept->clear();
    const std::size_t first =
        c.model.is_coupled ? std::max<std::size_t>(begin, c.model.liquid_count) : begin;
    if (first >= end) return;
    c.model.has_friction ? add_block<true>(c, motion, first, end, kept)
                         : add_block<false>(c, motion, first, end, kept);
  });
}

}  // namespace vat
