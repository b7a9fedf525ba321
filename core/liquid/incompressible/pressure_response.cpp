#include "core/liquid/incompressible/pressure_response.h"
#include "core/liquid/pairs/scratch.h"

#include <algorithm>
#include <cmath>

#include "core/liquid/pairs/coupled_pairs.h"
#include "core/liquid/pairs/liquid_pairs.h"
#include "core/state/rigid_motion.h"
#include "core/support/check.h"

namespace vat {
namespace {

/// The factor between a sum along g x and one of V dW/dx.
Real gradient_factor(const Model& model, const LiquidModel& liquid) {
  return slope_factor(model, liquid) / liquid.slope_scale;
}

/// Sets the motion of a liquid slot and of its source.
void set_liquid_motion(PairSources& sources, std::span<Vec3> motions, std::size_t slot,
                       const Vec3& motion) {
  motions[slot] = motion;
  const Vec3 weighted = sources.weight(slot) * motion;
  sources.set_motion(slot, motion_of(0, weighted));
}

/// The maximum of G / rho over the liquids.
Real greatest_mobility(const Model& model) {
  const auto mobility = by_material(
      model, [](const LiquidModel& liquid) { return liquid.slope_scale / liquid.rest_density; });
  return std::ranges::max(mobility);
}

}  // namespace

PressureResponse::PressureResponse(const ForceModel& force_model, Configuration& at,
                                   ResponseScratch& scratch, bool solids_move)
    : f_(force_model),
      at_(at),
      context_{f_.model, f_.controls, 0, f_.step, at, scratch.unused, f_.work, f_.runner},
      sums_(pair_sums_of(context_)),
      scratch_(scratch),
      order_(f_.work.of<LiquidScratch>().liquid.grid.order()),
      solids_(f_.work.of<LiquidScratch>().solids_in_liquid.grid.order()),
      has_solids_(has_solids(f_.model)),
      solids_move_(solids_move && has_solids_),
      has_several_liquids_(has_several_liquids(f_.model)),
      greatest_mobility_(greatest_mobility(f_.model)) {
  scratch_.liquid_motion.resize(order_.size());
  set_factors();
  f_.work.of<LiquidScratch>().sources.make_room_for_motions();
  if (!has_solids_) return;
  weigh_solids();
  find_slopes();
  scratch_.solid_motion.assign(solids_.size(), Vec3::Zero());
  scratch_.solid_force.resize(solids_.size());
  scratch_.rigid_force.resize(f_.model.rigid_bodies.size());
  scratch_.rigid_torque.resize(f_.model.rigid_bodies.size());
  scratch_.rigid_turning.resize(f_.model.rigid_bodies.size());
}

void PressureResponse::set_factors() {
  const Model& model = f_.model;
  const auto acceleration = by_material(model, [&](const LiquidModel& liquid) {
    return slope_factor(model, liquid) / liquid.rest_density;
  });
  const auto rate =
      by_material(model, [&](const LiquidModel& liquid) { return gradient_factor(model, liquid); });
  scratch_.acceleration_factor.resize(order_.size());
  const auto density = by_material(
      model, [](const LiquidModel& liquid) { return liquid.rest_density / liquid.slope_scale; });
  scratch_.rate_factor.resize(order_.size());
  scratch_.inertia.resize(order_.size());
  scratch_.partial.resize(block_count(order_.size()));
  for_blocks(f_.runner, order_.size(), [&](std::size_t begin, std::size_t end) {
    for (std::size_t s = begin; s < end; ++s) {
      const Index i = order_[s];
      const Index material = model.material[i];
      const bool moves = model.inverse_mass[i] > 0;
      scratch_.acceleration_factor[s] = moves ? acceleration[material] : 0;
      scratch_.inertia[s] = moves ? model.rest_volume[i] * density[material] : 0;
      scratch_.rate_factor[s] = rate[material];
    }
  });
}

void PressureResponse::weigh_solids() {
  WeightFactors factors;
  factors.solid = 2;
  f_.work.of<LiquidScratch>().sources.set_weights(context_, factors);
}

void PressureResponse::charge(std::span<const Real> pressure) {
  f_.work.of<LiquidScratch>().sources.set_charges(f_.runner,
                                                  [&](std::size_t s) { return pressure[s]; });
}

void PressureResponse::accelerate(std::span<const Real> pressure) {
  store_whole();
  charge(pressure);
  VAT_CHECK(pressure.size() == order_.size());
  accelerate_liquid(pressure);
  if (solids_move_) push_solids(pressure);
}

void PressureResponse::accelerate_liquid(std::span<const Real> pressure) {
  LiquidScratch& buffers = f_.work.of<LiquidScratch>();
  const std::span<const Real> factor = scratch_.acceleration_factor;
  const std::span<const VolumeSlope> slopes = buffers.volume_slopes;
  const std::span<Vec3> motions = scratch_.liquid_motion;
  // Copies of the spans, which the loop need not load again for each slot.
  const auto set_acceleration = [=, &sources = buffers.sources](const TargetCluster&, Index s,
                                                                const Real* sums) {
    const Vec3 sum = pressure[s] * slopes[s].gradient + Eigen::Map<const Vec3>(sums);
    set_liquid_motion(sources, motions, s, -factor[s] * sum);
  };
  buffers.liquid_clusters.for_each_sum<3>(f_.runner, charged_pair_inputs(context_), sums_.gradient,
                                          set_acceleration);
}

/// Computes the forces on solid particles and bodies, and the accelerations of all solid particles.
void PressureResponse::push_solids(std::span<const Real> pressure) {
  if (has_several_liquids_) {
    set_slope_weights(context_);
    charge(pressure);
  }
  sum_solid_forces();
  if (has_several_liquids_) weigh_solids();
  sum_rigid_forces();
  for_blocks(f_.runner, solids_.size(), [&](std::size_t begin, std::size_t end) {
    for (std::size_t s = begin; s < end; ++s) {
      scratch_.solid_motion[s] = solid_acceleration(f_.model.liquid_count + solids_[s]);
    }
  });
}

void PressureResponse::sum_solid_forces() {
  LiquidScratch& buffers = f_.work.of<LiquidScratch>();
  const Model& model = f_.model;
  const Real factor = -2 * slope_factor(model, *model.liquids[model.material[0]]);
  const Index first = buffers.sources.first_solid();
  buffers.solid_clusters.for_each_sum<3>(
      f_.runner, charged_pair_inputs(context_), sums_.gradient,
      [&](const TargetCluster&, Index n, const Real* sums) {
        const Index b = solids_[n - first];
        const Real volume = model.rest_volume[model.liquid_count + b];
        scratch_.solid_force[b] = factor * volume * Eigen::Map<const Vec3>(sums);
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
    apply_axle(rigid, scratch_.rigid_force[b], scratch_.rigid_torque[b]);
    scratch_.rigid_turning[b] =
        angular_velocity(rigid, at_.rigid[b].orientation, scratch_.rigid_torque[b]);
  }
}

/// The acceleration by forces only, without that of a body's own rotation.
Vec3 PressureResponse::solid_acceleration(Index particle) const {
  const Model& model = f_.model;
  if (particle < model.free_count) {
    return model.inverse_mass[particle] * scratch_.solid_force[particle - model.liquid_count];
  }
  const Index b = model.bodies[model.body[particle]].rigid;
  const Vec3 offset = at_.position[particle] - at_.rigid[b].center_of_mass;
  return model.rigid_bodies[b].inverse_mass * scratch_.rigid_force[b] +
         scratch_.rigid_turning[b].cross(offset);
}

Real PressureResponse::energy() {
  for_blocks(f_.runner, order_.size(), [&](std::size_t begin, std::size_t end) {
    Real sum = 0;
    for (std::size_t s = begin; s < end; ++s) {
      sum += scratch_.inertia[s] * scratch_.liquid_motion[s].squaredNorm();
    }
    scratch_.partial[begin / kBlockSize] = sum;
  });
  Real total = 0;
  for (const Real part : scratch_.partial) total += part;
  if (!solids_move_) return total;
  const Real scale = f_.model.liquids[f_.model.material[0]]->slope_scale;
  for (std::size_t s = 0; s < solids_.size(); ++s) {
    total += scratch_.solid_force[solids_[s]].dot(scratch_.solid_motion[s]) / scale;
  }
  return total;
}

void PressureResponse::see_velocities(const Vec3& wall_velocity) {
  store_whole();
  PairSources& sources = f_.work.of<LiquidScratch>().sources;
  for_blocks(f_.runner, order_.size(), [&](std::size_t begin, std::size_t end) {
    for (std::size_t s = begin; s < end; ++s) {
      set_liquid_motion(sources, scratch_.liquid_motion, s,
                        at_.velocity[order_[s]] - wall_velocity);
    }
  });
  if (!has_solids_) return;
  for (std::size_t s = 0; s < solids_.size(); ++s) {
    scratch_.solid_motion[s] = at_.velocity[f_.model.liquid_count + solids_[s]] - wall_velocity;
  }
}

void PressureResponse::compress(std::span<Real> rate) {
  compress_to(rate, [](std::size_t) { return Real{1}; });
}

void PressureResponse::compress(std::span<Real> product, std::span<const Real> scale, Real factor) {
  compress_to(product, [=](std::size_t s) { return factor * scale[s]; });
}

template <class Scale>
void PressureResponse::compress_to(std::span<Real> rate, Scale&& scale) {
  VAT_CHECK(rate.size() == order_.size());
  LiquidScratch& buffers = f_.work.of<LiquidScratch>();
  PairSources& sources = buffers.sources;
  sources.set_turned_motions(f_.runner, [&](std::size_t s) {
    const Vec3 weighted = sources.weight(sources.first_solid() + s) * scratch_.solid_motion[s];
    return motion_of(0, weighted);
  });
  const std::span<const Real> factor = scratch_.rate_factor;
  const std::span<const VolumeSlope> slopes = buffers.volume_slopes;
  const std::span<const Vec3> motions = scratch_.liquid_motion;
  const auto set_rate = [=](const TargetCluster&, Index s, const Real* sum) {
    const Real own = motions[s].dot(slopes[s].gradient);
    rate[s] = (own - *sum) * factor[s] * scale(s);
  };
  buffers.liquid_clusters.for_each_sum<1>(f_.runner, pair_inputs(context_), sums_.divergence,
                                          set_rate);
}

void PressureResponse::add(Real share) {
  VAT_CHECK(!has_share_);
  share_ = share;
  has_share_ = true;
}

void PressureResponse::store_whole() {
  if (!has_share_) return;
  const auto store = [&](std::vector<Vec3>& whole, const std::vector<Vec3>& part) {
    VAT_CHECK(!has_whole_ || whole.size() == part.size());
    whole.resize(part.size());
    for_blocks(f_.runner, part.size(), [&](std::size_t begin, std::size_t end) {
      for (std::size_t k = begin; k < end; ++k) whole[k] = total(whole, part, k);
    });
  };
  store(scratch_.liquid_whole, scratch_.liquid_motion);
  if (solids_move_) {
    store(scratch_.solid_force_whole, scratch_.solid_force);
    store(scratch_.rigid_force_whole, scratch_.rigid_force);
    store(scratch_.rigid_torque_whole, scratch_.rigid_torque);
  }
  has_whole_ = true;
  has_share_ = false;
}

void PressureResponse::kick(Real dt) {
  if (!has_share_) return;
  const Model& model = f_.model;
  for_blocks(f_.runner, order_.size(), [&](std::size_t begin, std::size_t end) {
    for (std::size_t s = begin; s < end; ++s) {
      at_.velocity[order_[s]] += dt * total(scratch_.liquid_whole, scratch_.liquid_motion, s);
    }
  });
  if (!solids_move_) return;
  for (Index i = model.liquid_count; i < model.free_count; ++i) {
    at_.velocity[i] +=
        (dt * model.inverse_mass[i]) *
        total(scratch_.solid_force_whole, scratch_.solid_force, i - model.liquid_count);
  }
  for (std::size_t b = 0; b < model.rigid_bodies.size(); ++b) {
    at_.rigid[b].momentum += dt * total(scratch_.rigid_force_whole, scratch_.rigid_force, b);
    at_.rigid[b].angular_momentum +=
        dt * total(scratch_.rigid_torque_whole, scratch_.rigid_torque, b);
    pose_rigid_body(model, model.rigid_bodies[b], at_.rigid[b], at_);
  }
}

void PressureResponse::shift(Real share) {
  if (!has_share_) return;
  for_blocks(f_.runner, order_.size(), [&](std::size_t begin, std::size_t end) {
    for (std::size_t s = begin; s < end; ++s) {
      at_.position[order_[s]] += share * total(scratch_.liquid_whole, scratch_.liquid_motion, s);
    }
  });
}

/// G / rho; 0 for a particle that does not move.
Real PressureResponse::mobility_of_liquid(Index particle) const {
  if (f_.model.inverse_mass[particle] == 0) return 0;
  const LiquidModel& liquid = liquid_of(f_.model, particle);
  return liquid.slope_scale / liquid.rest_density;
}

/// Each solid particle counts with its own mobility.
void PressureResponse::find_slopes() {
  LiquidScratch& buffers = f_.work.of<LiquidScratch>();
  const Model& model = f_.model;
  buffers.sources.set_motions(
      f_.runner,
      [&](std::size_t s) {
        return PairMotion{mobility_of_liquid(order_[s]) / greatest_mobility_, 0, 0, 0};
      },
      [&](std::size_t s) {
        const Index particle = model.liquid_count + solids_[s];
        const Real mobility = greatest_inverse_mass(model, particle, f_.step);
        return PairMotion{0, std::sqrt(mobility), 0, 0};
      },
      [](const PairImage&, const PairMotion& source) { return source; });
  const Real scale = reference_kernel(model).scale() * greatest_mobility_;
  buffers.volume_slopes.resize(order_.size());
  buffers.liquid_clusters.for_each_sum<kResponseSums>(
      f_.runner, pair_inputs(context_), sums_.response,
      [&](const TargetCluster&, Index s, const Real* sums) {
        const Real slope_scale = liquid_of(model, order_[s]).slope_scale;
        const Real solids = slope_scale * sums[4] * sums[4];
        buffers.volume_slopes[s] = {Eigen::Map<const Vec3>(sums), sums[3] + solids / scale};
      });
}

/// V_i G (|sum_j V_j grad W_ij|^2 / rho_i + V_i sum_j V_j |grad W_ij|^2 / rho_j), with the minimum
/// density for all other particles.
void PressureResponse::find_diagonal(std::span<Real> diagonal) {
  const Model& model = f_.model;
  VAT_CHECK(diagonal.size() == order_.size());
  const Real scale = reference_kernel(model).scale() * greatest_mobility_;
  const auto factor = by_material(model, [&](const LiquidModel& liquid) {
    const Real gradient = gradient_factor(model, liquid);
    return gradient * gradient;
  });
  const auto mobility = by_material(
      model, [](const LiquidModel& liquid) { return liquid.slope_scale / liquid.rest_density; });
  const std::span<const VolumeSlope> slopes = f_.work.of<LiquidScratch>().volume_slopes;
  for_blocks(f_.runner, order_.size(), [&](std::size_t begin, std::size_t end) {
    for (std::size_t s = begin; s < end; ++s) {
      const Index i = order_[s];
      const Index material = model.material[i];
      const Real volume = model.rest_volume[i];
      const Real own = model.inverse_mass[i] > 0 ? mobility[material] : 0;
      const Real square = slopes[s].gradient.squaredNorm();
      diagonal[s] = volume * factor[material] * (own * square + volume * scale * slopes[s].squares);
    }
  });
}

}  // namespace vat
