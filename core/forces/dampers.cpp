#include "core/forces/dampers.h"

#include "core/forces/contact_rules.h"
#include "core/forces/liquid_pairs.h"
#include "core/forces/neighbour_lists.h"
#include "core/forces/no_slip.h"
#include "core/forces/restitution.h"
#include "core/forces/walls.h"
#include "core/forces/weakly_compressible_pairs.h"
#include "core/step/force_model.h"

namespace vat {
namespace {

void add_wall_dampers(const Yieldings& yieldings, const VatMotion& motion, Index i,
                      const std::vector<Vec3>& spins, DamperBlock& block) {
  const Model& model = yieldings.model;
  const Configuration& at = yieldings.at;
  const ContactLaw& law = model.wall_laws[model.material[i]];
  const Friction friction = wall_friction(model, i);
  if (law.damping == 0 && law.damping_ratio == 0 && !friction.acts()) return;
  const Real threshold = law.threshold > 0 ? law.threshold : model.radius[i];
  for (const int wall : model.walls) {
    const Real overlap = threshold - wall_distance(*model.scene.vat, motion, wall, at.position[i]);
    if (overlap <= 0) continue;
    const Vec3 n = wall_normal(wall);
    const Real speed = (at.velocity[i] - motion.velocity).dot(n);
    const Real damping = yieldings.wall_damping(i, n);
    const Real push = law.stiffness * overlap - damping * speed;
    if (push <= 0) continue;
    block.dampers.push_back({kNoParticle, damping, n});
    if (!friction.acts()) continue;
    const Vec3 arm = wall_arm(model, i, wall, threshold - overlap);
    const Vec3 slip = wall_slip(*model.scene.vat, motion, wall,
                                at.velocity[i] + turning_velocity(model, spins, i, arm));
    block.rubs.push_back({kNoParticle, friction.drag(push, slip), n, arm, Vec3::Zero()});
  }
}

void add_no_slip_dampers(const Model& model, const Workspace& work, const VatMotion& motion,
                         const Configuration& at, Index i, std::vector<Damper>& dampers) {
  for (const int wall : model.no_slip_walls) {
    const Real d = wall_distance(*model.scene.vat, motion, wall, at.position[i]);
    const Real drag = no_slip_drag(model, work, i, d);
    if (drag == 0) continue;
    for (int axis = 0; axis < 3; ++axis) {
      if (axis != wall / 2) dampers.push_back({kNoParticle, drag, Vec3(Vec3::Unit(axis))});
    }
  }
}

void add_settling_dampers(const Model& model, Real time, Index i, std::vector<Damper>& dampers) {
  if (!model.scene.settling || time >= model.scene.settling->until) return;
  const Real drag = model.mass[i] * model.scene.settling->drag;
  for (int axis = 0; axis < 3; ++axis) {
    dampers.push_back({kNoParticle, drag, Vec3(Vec3::Unit(axis))});
  }
}

}  // namespace

void DampingMatrix::collect(const ForceModel& f, const Configuration& at, Real time,
                            bool viscosity) {
  const Model& model = f.model;
  is_viscous_ = viscosity && (model.is_coupled || has_viscosity(model));
  const VatMotion motion = model.scene.vat ? vat_motion(*model.scene.vat, time) : VatMotion{};
  blocks_.resize(block_count(model.particle_count));
  for_blocks(f.runner, model.particle_count, [&](std::size_t begin, std::size_t end) {
    DamperBlock& block = blocks_[begin / kBlockSize];
    block.clear();
    for (std::size_t k = begin; k < end; ++k) {
      const auto i = static_cast<Index>(k);
      block.start(k - begin);
      const bool is_mirrored = model.is_coupled && i < model.liquid_count;
      if (!is_mirrored) {
        add_wall_dampers({model, f.work, at, f.step}, motion, i, f.work.spins, block);
      }
      if (i < model.liquid_count && is_viscous_ && !model.is_coupled) {
        add_no_slip_dampers(model, f.work, motion, at, i, block.dampers);
      }
      if (i < model.liquid_count && viscosity) {
        add_settling_dampers(model, time, i, block.dampers);
      }
    }
    block.start(end - begin);
  });
  if (is_viscous_) collect_viscosity(f);
  has_images_ = is_viscous_ && has_viscous_images(model);
  if (has_images_) images_.collect(f, time);
  has_solid_drags_ = is_viscous_ && model.is_coupled && has_solids(model);
  if (has_solid_drags_) solid_drags_.collect(f);
}

namespace {

/// Of a pair of liquid slots: what add_liquid_forces() has for the difference of velocities, or
/// add_tait_forces() for its part along x, over |x|^2.
Real pair_viscosity(const ForceModel& f, Index slot, Index other_slot) {
  const Model& model = f.model;
  const std::span<const Index> order = f.work.liquid.grid.order();
  const LiquidModel& liquid = liquid_of(model, order[slot]);
  const LiquidRecord& own = f.work.liquid_records[slot];
  const LiquidRecord& other = f.work.liquid_records[other_slot];
  const Real r = model.periodic.nearest(own.position - other.position).norm();
  if (model.is_coupled) {
    return -mean_viscosity(liquid, liquid_of(model, order[other_slot])) * liquid.slope_scale *
           own.volume * other.volume * liquid.kernel.slope_over_r(r) / softened_square(liquid, r);
  }
  const Real strength =
      liquid.viscosity * own.volume * other.volume * liquid.viscosity_kernel.laplacian(r);
  return model.no_slip_walls.empty()
             ? strength
             : strength * (f.work.filling[slot] * f.work.filling[other_slot]);
}

}  // namespace

void DampingMatrix::collect_viscosity(const ForceModel& f) {
  if (f.model.is_coupled) list_neighbours(f.model, f.work, f.runner);
  viscosities_.resize(block_count(f.model.liquid_count));
  for_blocks(f.runner, f.model.liquid_count, [&](std::size_t begin, std::size_t end) {
    const PairBlock& pairs = f.work.liquid_pairs[begin / kBlockSize];
    std::vector<Real>& viscosities = viscosities_[begin / kBlockSize];
    viscosities.resize(pairs.begin[end - begin]);
    for (std::size_t s = begin; s < end; ++s) {
      for (Index k = pairs.begin[s - begin]; k < pairs.begin[s - begin + 1]; ++k) {
        viscosities[k] = pair_viscosity(f, static_cast<Index>(s), pairs.slots[k]);
      }
    }
  });
}

namespace {

/// What the dampers of the block's k-th particle, `i`, do to it.
Vec3 damp(const DamperBlock& block, std::size_t k, const std::vector<Vec3>& w, std::size_t i) {
  Vec3 sum = Vec3::Zero();
  for (Index d = block.begin[k]; d < block.begin[k + 1]; ++d) {
    const Damper& damper = block.dampers[d];
    const Vec3 change = damper.other == kNoParticle ? w[i] : Vec3(w[i] - w[damper.other]);
    sum -= damper.strength * change.dot(damper.direction) * damper.direction;
  }
  return sum;
}

/// What friction of the block's k-th particle, `i`, does to it.
ContactForce rub(const Model& model, const DamperBlock& block, std::size_t k,
                 const std::vector<Vec3>& w, const std::vector<Vec3>& spins, Index i) {
  ContactForce sum;
  for (Index d = block.rub_begin[k]; d < block.rub_begin[k + 1]; ++d) {
    const RubDamper& damper = block.rubs[d];
    Vec3 change = w[i] + turning_velocity(model, spins, i, damper.arm);
    if (damper.other != kNoParticle) {
      change -= w[damper.other] + turning_velocity(model, spins, damper.other, damper.other_arm);
    }
    const Vec3 force =
        -damper.strength * slip_velocity(change, change.dot(damper.normal), damper.normal);
    sum.force += force;
    sum.torque += damper.arm.cross(force);
  }
  return sum;
}

Vec3 damp_springs(const Model& model, const std::vector<Vec3>& directions,
                  const std::vector<Vec3>& w, std::size_t i) {
  Vec3 sum = Vec3::Zero();
  for (Index s = model.spring_begin[i]; s < model.spring_begin[i + 1]; ++s) {
    const SpringEnd& spring = model.spring_ends[s];
    const Vec3& n = directions[s];
    sum -= spring.damping * (w[i] - w[spring.other]).dot(n) * n;
  }
  return sum;
}

}  // namespace

void DampingMatrix::multiply(const ForceModel& f, const std::vector<Vec3>& w,
                             const std::vector<Vec3>& spins, std::vector<Vec3>& force,
                             std::vector<Vec3>& torque) {
  const bool has_contacts = has_contact_forces(f.model);
  const bool has_springs = !f.model.spring_ends.empty();
  for_blocks(f.runner, f.model.particle_count, [&](std::size_t begin, std::size_t end) {
    const std::size_t block = begin / kBlockSize;
    for (std::size_t i = begin; i < end; ++i) {
      force[i] = damp(blocks_[block], i - begin, w, i);
      if (has_springs && i < f.model.implicit_begin) {
        force[i] += damp_springs(f.model, f.work.spring_directions, w, i);
      }
      if (has_contacts) force[i] += damp(f.work.contact_dampers[block], i - begin, w, i);
      if (!f.model.has_friction) continue;
      torque[i].setZero();
      const auto add = [&](const DamperBlock& dampers) {
        const ContactForce rubbing =
            rub(f.model, dampers, i - begin, w, spins, static_cast<Index>(i));
        force[i] += rubbing.force;
        torque[i] += rubbing.torque;
      };
      add(blocks_[block]);
      if (has_contacts) add(f.work.contact_dampers[block]);
    }
  });
  if (!is_viscous_) return;

  const std::span<const Index> order = f.work.liquid.grid.order();
  by_slot_.resize(order.size());
  for (std::size_t s = 0; s < order.size(); ++s) by_slot_[s] = w[order[s]];
  for_blocks(f.runner, order.size(), [&](std::size_t begin, std::size_t end) {
    const PairBlock& pairs = f.work.liquid_pairs[begin / kBlockSize];
    const std::vector<Real>& viscosities = viscosities_[begin / kBlockSize];
    for (std::size_t s = begin; s < end; ++s) {
      Vec3 sum = Vec3::Zero();
      for (Index k = pairs.begin[s - begin]; k < pairs.begin[s - begin + 1]; ++k) {
        const Vec3 change = by_slot_[pairs.slots[k]] - by_slot_[s];
        if (f.model.is_coupled) {
          const Vec3 x = f.model.periodic.nearest(f.work.liquid_records[s].position -
                                                  f.work.liquid_records[pairs.slots[k]].position);
          sum += viscosities[k] * change.dot(x) * x;
        } else {
          sum += viscosities[k] * change;
        }
      }
      force[order[s]] += sum;
    }
  });
  if (has_images_) images_.add(f, w, force);
  if (has_solid_drags_) solid_drags_.add(f, w, force);
}

}  // namespace vat
