#include "core/damping/dampers.h"
#include "core/contact/scratch.h"
#include "core/liquid/pairs/scratch.h"
#include "core/model/acting_forces.h"
#include "core/solid/scratch.h"

#include <algorithm>

#include "core/contact/contact_rules.h"
#include "core/contact/walls.h"
#include "core/damping/liquid_drags.h"
#include "core/liquid/pairs/coupled_pairs.h"
#include "core/liquid/pairs/liquid_pairs.h"
#include "core/liquid/pairs/no_slip.h"
#include "core/liquid/pairs/weakly_compressible_pairs.h"
#include "core/solid/spring_sums.h"
#include "core/support/check.h"

namespace vat {
namespace {

void add_no_slip_dampers(const Model& model, const Scratch& work, const VatMotion& motion,
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

bool is_settling(const Model& model, Real time) {
  return model.scene.settling && time < model.scene.settling->until;
}

void add_settling_dampers(const Model& model, Index i, std::vector<Damper>& dampers) {
  const Real drag = model.mass[i] * model.scene.settling->drag;
  for (int axis = 0; axis < 3; ++axis) {
    dampers.push_back({kNoParticle, drag, Vec3(Vec3::Unit(axis))});
  }
}

}  // namespace

void DampingMatrix::collect(const StepContext& c, bool viscosity) {
  const Model& model = c.model;
  const bool is_coupled = model.is_coupled;
  has_liquid_drags_ = viscosity && is_coupled && has_central_viscosity(model);
  is_viscous_ = viscosity && !is_coupled && has_viscosity(model);
  collect_own(c, viscosity);
  if (is_viscous_) collect_viscosity(c);
  collect_blocks(c);
  collect_rigid(c);
}

void DampingMatrix::collect_own(const StepContext& c, bool viscosity) {
  const Model& model = c.model;
  const VatMotion motion = motion_of(c);
  const bool has_no_slip = is_viscous_ && !model.no_slip_walls.empty();
  const bool settles = viscosity && is_settling(model, c.time);
  has_own_ = has_no_slip || settles;
  if (!has_own_) return;
  own_.resize(block_count(model.liquid_count));
  for_blocks(c.runner, model.liquid_count, [&](std::size_t begin, std::size_t end) {
    DamperBlock& block = own_[begin / kBlockSize];
    block.clear();
    for (std::size_t k = begin; k < end; ++k) {
      const auto i = static_cast<Index>(k);
      if (has_no_slip)
        add_no_slip_dampers(model, c.work, motion, c.configuration, i, block.dampers);
      if (settles) add_settling_dampers(model, i, block.dampers);
      block.close(i);
    }
  });
}

void DampingMatrix::collect_blocks(const StepContext& c) {
  const Model& model = c.model;
  blocks_.clear();
  for (std::size_t b = 0; b < block_count(model.particle_count); ++b) {
    const std::size_t begin = b * kBlockSize;
    bool has_rows = has_liquid_drags_ || (is_viscous_ && begin < model.liquid_count) ||
                    (!model.spring_ends.empty() && begin < model.free_count &&
                     begin + kBlockSize > model.liquid_count);
    for_kept_blocks(c, b, [&](const DamperBlock& block) { has_rows |= !block.rows.empty(); });
    if (has_rows) blocks_.push_back(b);
  }
}

void DampingMatrix::collect_rigid(const StepContext& c) {
  const Model& model = c.model;
  rigid_.clear();
  if (has_liquid_drags_ && has_solids(model)) {
    for (Index i = model.free_count; i < model.particle_count; ++i) rigid_.push_back(i);
    return;
  }
  for (std::size_t b = model.free_count / kBlockSize; b < block_count(model.particle_count); ++b) {
    const std::size_t first = rigid_.size();
    for_kept_blocks(c, b, [&](const DamperBlock& block) {
      for (const DamperBlock::Row& row : block.rows) {
        if (row.particle >= model.free_count) rigid_.push_back(row.particle);
      }
    });
    const auto of_block = std::span(rigid_).subspan(first);
    std::ranges::sort(of_block);
    const auto last = std::unique(of_block.begin(), of_block.end());
    rigid_.resize(rigid_.size() - static_cast<std::size_t>(of_block.end() - last));
  }
}

template <class F>
void DampingMatrix::for_kept_blocks(const StepContext& c, std::size_t block, F&& visit) const {
  ContactForceScratch& contact_buffers = c.work.of<ContactForceScratch>();
  if (has_own_ && block < own_.size()) visit(own_[block]);
  if (has_contact_forces(c.model)) visit(contact_buffers.contact_dampers[block]);
  if (has_wall_forces(c.model)) visit(contact_buffers.wall_dampers[block]);
}

namespace {

/// The viscosity of a pair of liquid slots: the factor of the difference of velocities in
/// add_liquid_forces().
Real pair_viscosity(const StepContext& c, Index slot, Index other_slot) {
  LiquidScratch& buffers = c.work.of<LiquidScratch>();
  const LiquidModel& liquid = liquid_of(c.model, buffers.liquid.grid.order()[slot]);
  const LiquidRecord& own = buffers.liquid_records[slot];
  const LiquidRecord& other = buffers.liquid_records[other_slot];
  const Real r = c.model.periodic.nearest(own.position - other.position).norm();
  const Real strength =
      liquid.viscosity * own.volume * other.volume * liquid.viscosity_kernel.laplacian(r);
  return c.model.no_slip_walls.empty()
             ? strength
             : strength * (buffers.filling[slot] * buffers.filling[other_slot]);
}

}  // namespace

void DampingMatrix::collect_viscosity(const StepContext& c) {
  viscosities_.resize(block_count(c.model.liquid_count));
  for_blocks(c.runner, c.model.liquid_count, [&](std::size_t begin, std::size_t end) {
    const PairBlock& pairs = c.work.of<LiquidScratch>().liquid_pairs[begin / kBlockSize];
    std::vector<Real>& viscosities = viscosities_[begin / kBlockSize];
    viscosities.resize(pairs.begin[end - begin]);
    for (std::size_t s = begin; s < end; ++s) {
      for (Index k = pairs.begin[s - begin]; k < pairs.begin[s - begin + 1]; ++k) {
        viscosities[k] = pair_viscosity(c, static_cast<Index>(s), pairs.slots[k]);
      }
    }
  });
}

namespace {

/// The force of a damper on particle i.
Vec3 damp(const Damper& damper, const std::vector<Vec3>& w, Index i) {
  const Vec3 change = damper.other == kNoParticle ? w[i] : Vec3(w[i] - w[damper.other]);
  return -damper.strength * change.dot(damper.direction) * damper.direction;
}

ContactForce friction_force(const Model& model, const FrictionDamper& damper,
                            const std::vector<Vec3>& w, const std::vector<Vec3>& spins, Index i) {
  Vec3 change = w[i] + turning_velocity(model, spins, i, damper.arm);
  if (damper.other != kNoParticle) {
    change -= w[damper.other] + turning_velocity(model, spins, damper.other, damper.other_arm);
  }
  const Vec3 force =
      -damper.strength * slip_velocity(change, change.dot(damper.normal), damper.normal);
  return {force, damper.arm.cross(force)};
}

void damp_springs(const StepContext& c, const std::vector<Vec3>& w, Index begin, Index end,
                  std::vector<Vec3>& force) {
  const SpringEnd* const ends = c.model.spring_ends.data();
  const Vec3* const directions = c.work.of<SolidScratch>().spring_directions.data();
  BlockSums sums;
  sum_over_springs(c.model, begin, end, sums, [&, changes = w.data()](Index e) {
    return [=, own = changes[e]](Index s) -> Vec3 {
      const Vec3& n = directions[s];
      return (-ends[s].damping * (own - changes[ends[s].other]).dot(n)) * n;
    };
  });
  std::copy_n(sums.begin(), end - begin, force.begin() + begin);
}

}  // namespace

void DampingMatrix::multiply(const StepContext& c, const std::vector<Vec3>& w,
                             const std::vector<Vec3>& spins, std::vector<Vec3>& force,
                             std::vector<Vec3>& torque) {
  LiquidScratch& buffers = c.work.of<LiquidScratch>();
  const Model& model = c.model;
  VAT_CHECK(w.size() == c.model.particle_count && force.size() == c.model.particle_count);
  for_blocks<1>(c.runner, blocks_.size(), [&](std::size_t n, std::size_t) {
    const std::size_t begin = blocks_[n] * kBlockSize;
    const std::size_t end = std::min<std::size_t>(model.particle_count, begin + kBlockSize);
    std::fill(force.begin() + static_cast<std::ptrdiff_t>(begin),
              force.begin() + static_cast<std::ptrdiff_t>(end), Vec3::Zero());
    const Index springs_begin = std::max(static_cast<Index>(begin), model.liquid_count);
    const Index springs_end = std::min(static_cast<Index>(end), model.implicit_begin);
    if (springs_begin < springs_end) damp_springs(c, w, springs_begin, springs_end, force);
    for_kept_blocks(c, begin / kBlockSize, [&](const DamperBlock& block) {
      Index damper = 0;
      Index friction_index = 0;
      for (const DamperBlock::Row& row : block.rows) {
        const Index i = row.particle;
        for (; damper < row.damper_end; ++damper) force[i] += damp(block.dampers[damper], w, i);
        for (; friction_index < row.friction_end; ++friction_index) {
          const ContactForce part =
              friction_force(model, block.friction_dampers[friction_index], w, spins, i);
          force[i] += part.force;
          torque[i] += part.torque;
        }
      }
    });
  });
  if (has_liquid_drags_) add_liquid_drags(c, w, force);
  if (!is_viscous_) return;

  VAT_CHECK(viscosities_.size() == block_count(model.liquid_count));
  const std::span<const Index> order = buffers.liquid.grid.order();
  by_slot_.resize(order.size());
  for (std::size_t s = 0; s < order.size(); ++s) by_slot_[s] = w[order[s]];
  for_blocks(c.runner, order.size(), [&](std::size_t begin, std::size_t end) {
    const PairBlock& pairs = buffers.liquid_pairs[begin / kBlockSize];
    const std::vector<Real>& viscosities = viscosities_[begin / kBlockSize];
    for (std::size_t s = begin; s < end; ++s) {
      Vec3 sum = Vec3::Zero();
      for (Index k = pairs.begin[s - begin]; k < pairs.begin[s - begin + 1]; ++k) {
        const Vec3 change = by_slot_[pairs.slots[k]] - by_slot_[s];
        sum += viscosities[k] * change;
      }
      force[order[s]] += sum;
    }
  });
}

}  // namespace vat
