#include "core/incompressible/pressure_response.h"

#include <algorithm>
#include <cmath>

#include "core/forces/liquid_pairs.h"
#include "core/forces/mirrors.h"
#include "core/forces/weakly_compressible_pairs.h"
#include "core/rigid/rigid_motion.h"

namespace vat {
namespace {

/// Calls f(gradient) for those of one slot.
template <class F>
void for_each_gradient(const std::vector<GradientBlock>& blocks, std::size_t slot, F&& f) {
  const GradientBlock& block = blocks[slot / kBlockSize];
  for (Index k = block.begin[slot % kBlockSize]; k < block.begin[slot % kBlockSize + 1]; ++k) {
    f(block.entries[k]);
  }
}

}  // namespace

PressureResponse::PressureResponse(const ForceModel& force_model, Configuration& at,
                                   PressurePairs& pairs, ResponseScratch& scratch, bool solids_move)
    : f_(force_model),
      at_(at),
      pairs_(pairs),
      scratch_(scratch),
      order_(f_.work.liquid.grid.order()),
      solids_(f_.work.solids_in_liquid.grid.order()),
      has_solids_(has_solids(f_.model)),
      solids_move_(solids_move && has_solids_) {
  if (!has_solids_) return;
  scratch_.solid_motion.assign(solids_.size(), Vec3::Zero());
  scratch_.solid_force.resize(solids_.size());
  scratch_.rigid_force.resize(f_.model.rigid_bodies.size());
  scratch_.rigid_torque.resize(f_.model.rigid_bodies.size());
}

void PressureResponse::accelerate(std::span<const Real> pressure) {
  for_blocks(f_.runner, order_.size(), [&](std::size_t begin, std::size_t end) {
    for (std::size_t s = begin; s < end; ++s) pairs_.records[s].pressure = pressure[s];
  });
  f_.model.periodic.any() ? accelerate_liquid<true>() : accelerate_liquid<false>();
  if (solids_move_) push_solids();
}

template <bool periodic>
void PressureResponse::accelerate_liquid() {
  std::vector<LiquidRecord>& records = pairs_.records;
  for_blocks(f_.runner, order_.size(), [&](std::size_t begin, std::size_t end) {
    const PairBlock& block = f_.work.liquid_pairs[begin / kBlockSize];
    const std::vector<Real>& slopes = pairs_.slopes[begin / kBlockSize];
    for (std::size_t s = begin; s < end; ++s) {
      const LiquidRecord& own = records[s];
      Vec3 sum = Vec3::Zero();
      for (Index k = block.begin[s - begin]; k < block.begin[s - begin + 1]; ++k) {
        const LiquidRecord& other = records[block.slots[k]];
        Vec3 x = own.position - other.position;
        if constexpr (periodic) x = f_.model.periodic.nearest(x);
        sum += (other.volume * (own.pressure + other.pressure) * slopes[k]) * x;
      }
      for_each_gradient(pairs_.images, s, [&](const KernelGradient& image) {
        const LiquidRecord& other = records[image.slot];
        sum += (other.volume * (own.pressure + other.pressure)) * image.gradient;
      });
      if (has_solids_) {
        for_each_gradient(pairs_.solids, s, [&](const KernelGradient& solid) {
          sum += (2 * pairs_.solid_volume[solid.slot] * own.pressure) * solid.gradient;
        });
      }
      records[s].velocity = -mobility_of_liquid(order_[s]) * sum;
    }
  });
}

/// The forces on solid particles and bodies, and the accelerations of all solid particles.
void PressureResponse::push_solids() {
  const Model& model = f_.model;
  for_blocks(f_.runner, solids_.size(), [&](std::size_t begin, std::size_t end) {
    for (std::size_t s = begin; s < end; ++s) {
      Vec3 sum = Vec3::Zero();
      for_each_gradient(pairs_.of_solids, s, [&](const KernelGradient& liquid) {
        const LiquidRecord& other = pairs_.records[liquid.slot];
        const Real scale = liquid_of(model, order_[liquid.slot]).slope_scale;
        sum -= (2 * scale * other.volume * other.pressure) * liquid.gradient;
      });
      scratch_.solid_force[solids_[s]] = pairs_.solid_volume[s] * sum;
    }
  });
  sum_rigid_forces();
  for_blocks(f_.runner, solids_.size(), [&](std::size_t begin, std::size_t end) {
    for (std::size_t s = begin; s < end; ++s) {
      scratch_.solid_motion[s] = solid_acceleration(model.liquid_count + solids_[s]);
    }
  });
}

void PressureResponse::sum_rigid_forces() {
  const Model& model = f_.model;
  for (std::size_t b = 0; b < model.rigid_bodies.size(); ++b) {
    const RigidModel& rigid = model.rigid_bodies[b];
    Vec3 sum = Vec3::Zero();
    Vec3 torque = Vec3::Zero();
    const Vec3 center = at_.rigid[b].center_of_mass;
    const Index end = rigid.is_held(f_.step) ? rigid.particles.begin : rigid.particles.end;
    for (Index e = rigid.particles.begin; e < end; ++e) {
      const Vec3& force = scratch_.solid_force[e - model.liquid_count];
      sum += force;
      torque += (at_.position[e] - center).cross(force);
    }
    scratch_.rigid_force[b] = sum;
    scratch_.rigid_torque[b] = torque;
  }
}

/// By forces alone: what turns a body that spins anyway is no part of it.
Vec3 PressureResponse::solid_acceleration(Index particle) const {
  const Model& model = f_.model;
  if (particle < model.free_count) {
    return model.inverse_mass[particle] * scratch_.solid_force[particle - model.liquid_count];
  }
  const Index b = model.bodies[model.body[particle]].rigid;
  const RigidState& state = at_.rigid[b];
  const Vec3 turning =
      angular_velocity(model.rigid_bodies[b], state.orientation, scratch_.rigid_torque[b]);
  return model.rigid_bodies[b].inverse_mass * scratch_.rigid_force[b] +
         turning.cross(at_.position[particle] - state.center_of_mass);
}

void PressureResponse::see_velocities(const Vec3& wall_velocity) {
  for_blocks(f_.runner, order_.size(), [&](std::size_t begin, std::size_t end) {
    for (std::size_t s = begin; s < end; ++s) {
      pairs_.records[s].velocity = at_.velocity[order_[s]] - wall_velocity;
    }
  });
  if (!has_solids_) return;
  for (std::size_t s = 0; s < solids_.size(); ++s) {
    scratch_.solid_motion[s] = at_.velocity[f_.model.liquid_count + solids_[s]] - wall_velocity;
  }
}

void PressureResponse::compress(std::span<Real> rate) const {
  f_.model.periodic.any() ? compress_liquid<true>(rate) : compress_liquid<false>(rate);
}

template <bool periodic>
void PressureResponse::compress_liquid(std::span<Real> rate) const {
  const std::vector<LiquidRecord>& records = pairs_.records;
  for_blocks(f_.runner, order_.size(), [&](std::size_t begin, std::size_t end) {
    const PairBlock& block = f_.work.liquid_pairs[begin / kBlockSize];
    const std::vector<Real>& slopes = pairs_.slopes[begin / kBlockSize];
    for (std::size_t s = begin; s < end; ++s) {
      const LiquidRecord& own = records[s];
      Real sum = 0;
      for (Index k = block.begin[s - begin]; k < block.begin[s - begin + 1]; ++k) {
        const LiquidRecord& other = records[block.slots[k]];
        Vec3 x = own.position - other.position;
        if constexpr (periodic) x = f_.model.periodic.nearest(x);
        sum += other.volume * slopes[k] * x.dot(own.velocity - other.velocity);
      }
      for_each_gradient(pairs_.images, s, [&](const KernelGradient& image) {
        const LiquidRecord& other = records[image.slot];
        sum += other.volume *
               image.gradient.dot(own.velocity - Mirror{image.mirrored}.turn(other.velocity));
      });
      rate[s] = has_solids_ ? sum + 2 * compression_by_solids(s) : sum;
    }
  });
}

Real PressureResponse::compression_by_solids(std::size_t slot) const {
  Real sum = 0;
  for_each_gradient(pairs_.solids, slot, [&](const KernelGradient& solid) {
    const Vec3 other = Mirror{solid.mirrored}.turn(scratch_.solid_motion[solid.slot]);
    sum +=
        pairs_.solid_volume[solid.slot] * solid.gradient.dot(pairs_.records[slot].velocity - other);
  });
  return sum;
}

void PressureResponse::kick(Real dt) {
  const Model& model = f_.model;
  for_blocks(f_.runner, order_.size(), [&](std::size_t begin, std::size_t end) {
    for (std::size_t s = begin; s < end; ++s) {
      at_.velocity[order_[s]] += dt * pairs_.records[s].velocity;
    }
  });
  if (!solids_move_) return;
  for (Index i = model.liquid_count; i < model.free_count; ++i) {
    at_.velocity[i] += (dt * model.inverse_mass[i]) * scratch_.solid_force[i - model.liquid_count];
  }
  for (std::size_t b = 0; b < model.rigid_bodies.size(); ++b) {
    at_.rigid[b].momentum += dt * scratch_.rigid_force[b];
    at_.rigid[b].angular_momentum += dt * scratch_.rigid_torque[b];
    pose_rigid_body(model, model.rigid_bodies[b], at_.rigid[b], at_);
  }
}

void PressureResponse::shift(Real share) {
  for_blocks(f_.runner, order_.size(), [&](std::size_t begin, std::size_t end) {
    for (std::size_t s = begin; s < end; ++s) {
      at_.position[order_[s]] += share * pairs_.records[s].velocity;
    }
  });
}

/// G / rho; 0 where nothing moves it.
Real PressureResponse::mobility_of_liquid(Index particle) const {
  if (f_.model.inverse_mass[particle] == 0) return 0;
  const LiquidModel& liquid = liquid_of(f_.model, particle);
  return liquid.slope_scale / liquid.rest_density;
}

/// The inverse mass of the motion that a force on a solid particle starts, at most.
Real PressureResponse::mobility_of(Index particle) const {
  const Model& model = f_.model;
  if (particle < model.free_count) return model.inverse_mass[particle];
  const RigidModel& rigid = model.rigid_bodies[model.bodies[model.body[particle]].rigid];
  if (rigid.is_held(f_.step)) return 0;
  return rigid.inverse_mass + rigid.inverse_moments.maxCoeff() *
                                  model.local_position[particle - model.free_count].squaredNorm();
}

void PressureResponse::find_diagonal(std::span<Real> diagonal) {
  for_blocks(f_.runner, order_.size(), [&](std::size_t begin, std::size_t end) {
    for (std::size_t s = begin; s < end; ++s) {
      pairs_.records[s].pressure = mobility_of_liquid(order_[s]);
    }
  });
  for_blocks(f_.runner, order_.size(), [&](std::size_t begin, std::size_t end) {
    for (std::size_t s = begin; s < end; ++s) diagonal[s] = diagonal_of(s);
  });
}

/// V_i G (|sum_j V_j grad W_ij|^2 / rho_i + V_i sum_j V_j |grad W_ij|^2 / rho_j), with solids as
/// mobile as each of them is by itself. The records' pressure is G / rho.
Real PressureResponse::diagonal_of(std::size_t slot) const {
  const std::vector<LiquidRecord>& records = pairs_.records;
  const LiquidRecord& own = records[slot];
  Vec3 sum = Vec3::Zero();
  Real squares = 0;
  Real solids = 0;
  const auto add = [&](const LiquidRecord& other, const Vec3& gradient) {
    sum += other.volume * gradient;
    squares += own.volume * other.volume * other.pressure * gradient.squaredNorm();
  };
  const PairBlock& block = f_.work.liquid_pairs[slot / kBlockSize];
  const std::vector<Real>& slopes = pairs_.slopes[slot / kBlockSize];
  for (Index k = block.begin[slot % kBlockSize]; k < block.begin[slot % kBlockSize + 1]; ++k) {
    const LiquidRecord& other = records[block.slots[k]];
    add(other, slopes[k] * nearest_image(f_.model, own.position - other.position));
  }
  for_each_gradient(pairs_.images, slot,
                    [&](const KernelGradient& image) { add(records[image.slot], image.gradient); });
  if (has_solids_) {
    for_each_gradient(pairs_.solids, slot, [&](const KernelGradient& solid) {
      const Real volume = 2 * pairs_.solid_volume[solid.slot];
      const Real mobility = mobility_of(f_.model.liquid_count + solids_[solid.slot]);
      sum += volume * solid.gradient;
      solids += volume * solid.gradient.norm() * std::sqrt(mobility);
    });
  }
  const Real scale = liquid_of(f_.model, order_[slot]).slope_scale;
  return own.volume * (own.pressure * sum.squaredNorm() + squares) +
         own.volume * own.volume * scale * solids * solids;
}

}  // namespace vat
