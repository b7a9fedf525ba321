#include "core/incompressible/pressure_response.h"

#include <algorithm>
#include <cmath>

#include "core/forces/coupled_pairs.h"
#include "core/forces/liquid_pairs.h"
#include "core/rigid/rigid_motion.h"

namespace vat {
namespace {

/// Between a sum along g x and one of V dW/dx.
Real gradient_factor(const Model& model, const LiquidModel& liquid) {
  return slope_factor(model, liquid) / liquid.slope_scale;
}

PairMotion turned(const PairImage& image, const PairMotion& source) {
  return motion_of(source.pressure, image.turn({source.vx, source.vy, source.vz}));
}

}  // namespace

PressureResponse::PressureResponse(const ForceModel& force_model, Configuration& at,
                                   ResponseScratch& scratch, bool solids_move)
    : f_(force_model),
      at_(at),
      context_{f_.model, f_.controls, 0, f_.step, at, scratch.unused, f_.work, f_.runner},
      sums_(pair_sums_of(context_)),
      scratch_(scratch),
      order_(f_.work.liquid.grid.order()),
      solids_(f_.work.solids_in_liquid.grid.order()),
      has_solids_(has_solids(f_.model)),
      solids_move_(solids_move && has_solids_) {
  f_.work.pair_sums.resize(
      std::max(f_.work.pair_sums.size(), kResponseSums * std::max(order_.size(), solids_.size())));
  scratch_.liquid_motion.resize(order_.size());
  if (!has_solids_) return;
  weigh_solids();
  scratch_.solid_motion.assign(solids_.size(), Vec3::Zero());
  scratch_.solid_force.resize(solids_.size());
  scratch_.rigid_force.resize(f_.model.rigid_bodies.size());
  scratch_.rigid_torque.resize(f_.model.rigid_bodies.size());
}

void PressureResponse::weigh_solids() {
  WeightFactors factors;
  factors.solid = 2;
  f_.work.sources.set_weights(context_, factors);
}

void PressureResponse::accelerate(std::span<const Real> pressure) {
  f_.work.sources.set_motions(
      f_.runner,
      [&](std::size_t s) {
        return PairMotion{pressure[s], 0, 0, 0};
      },
      [](std::size_t) { return PairMotion{}; },
      [](const PairImage&, const PairMotion& source) { return source; });
  accelerate_liquid();
  if (solids_move_) push_solids();
}

void PressureResponse::accelerate_liquid() {
  Real* const sums = f_.work.pair_sums.data();
  const PairInputs inputs = force_inputs(context_);
  const auto factor = by_material(f_.model, [&](const LiquidModel& liquid) {
    return slope_factor(f_.model, liquid) / liquid.rest_density;
  });
  f_.work.liquid_clusters.for_each_chunk(f_.runner, inputs, [&](const PairInputs& in, auto chunk) {
    sums_.pressure(in, chunk, sums);
    for (const TargetCluster& cluster : chunk) {
      for (Index s = cluster.begin; s < cluster.end; ++s) {
        const Index i = order_[s];
        const Real own = f_.model.inverse_mass[i] > 0 ? factor[f_.model.material[i]] : 0;
        scratch_.liquid_motion[s] = own * Eigen::Map<const Vec3>(sums + 3 * std::size_t{s});
      }
    }
  });
}

/// The forces on solid particles and bodies, and the accelerations of all solid particles.
void PressureResponse::push_solids() {
  set_slope_weights(context_);
  sum_solid_forces();
  if (has_several_liquids(f_.model)) weigh_solids();
  sum_rigid_forces();
  for_blocks(f_.runner, solids_.size(), [&](std::size_t begin, std::size_t end) {
    for (std::size_t s = begin; s < end; ++s) {
      scratch_.solid_motion[s] = solid_acceleration(f_.model.liquid_count + solids_[s]);
    }
  });
}

void PressureResponse::sum_solid_forces() {
  const Model& model = f_.model;
  Real* const sums = f_.work.pair_sums.data();
  const Real factor = 2 * slope_factor(model, *model.liquids[model.material[0]]);
  const PairInputs inputs = solid_force_inputs(context_);
  f_.work.solid_clusters.for_each_chunk(f_.runner, inputs, [&](const PairInputs& in, auto chunk) {
    sums_.pressure(in, chunk, sums);
    for (const TargetCluster& cluster : chunk) {
      for (Index n = cluster.begin; n < cluster.end; ++n) {
        const std::size_t s = n - in.first_target;
        const Real volume = model.rest_volume[model.liquid_count + solids_[s]];
        scratch_.solid_force[solids_[s]] = factor * volume * Eigen::Map<const Vec3>(sums + 3 * s);
      }
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
      scratch_.liquid_motion[s] = at_.velocity[order_[s]] - wall_velocity;
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
  compress_to(product, [&](std::size_t s) { return factor * scale[s]; });
}

template <class Scale>
void PressureResponse::compress_to(std::span<Real> rate, Scale&& scale) {
  f_.work.sources.set_motions(
      f_.runner, [&](std::size_t s) { return motion_of(0, scratch_.liquid_motion[s]); },
      [&](std::size_t s) { return motion_of(0, scratch_.solid_motion[s]); }, turned);
  const PairInputs inputs = force_inputs(context_);
  const auto factor = by_material(
      f_.model, [&](const LiquidModel& liquid) { return gradient_factor(f_.model, liquid); });
  f_.work.liquid_clusters.for_each_chunk(f_.runner, inputs, [&](const PairInputs& in, auto chunk) {
    sums_.compression(in, chunk, rate.data());
    for (const TargetCluster& cluster : chunk) {
      for (Index s = cluster.begin; s < cluster.end; ++s) {
        rate[s] *= factor[f_.model.material[order_[s]]] * scale(s);
      }
    }
  });
}

void PressureResponse::kick(Real dt) {
  const Model& model = f_.model;
  for_blocks(f_.runner, order_.size(), [&](std::size_t begin, std::size_t end) {
    for (std::size_t s = begin; s < end; ++s) {
      at_.velocity[order_[s]] += dt * scratch_.liquid_motion[s];
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
      at_.position[order_[s]] += share * scratch_.liquid_motion[s];
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

/// V_i G (|sum_j V_j grad W_ij|^2 / rho_i + V_i sum_j V_j |grad W_ij|^2 / rho_j), with solids as
/// mobile as each of them is by itself.
void PressureResponse::find_diagonal(std::span<Real> diagonal) {
  const Model& model = f_.model;
  f_.work.sources.set_motions(
      f_.runner,
      [&](std::size_t s) {
        return PairMotion{mobility_of_liquid(order_[s]), 0, 0, 0};
      },
      [&](std::size_t s) {
        return PairMotion{0, std::sqrt(mobility_of(model.liquid_count + solids_[s])), 0, 0};
      },
      [](const PairImage&, const PairMotion& source) { return source; });
  Real* const all = f_.work.pair_sums.data();
  const Real scale = reference_kernel(model).scale();
  const PairInputs inputs = force_inputs(context_);
  f_.work.liquid_clusters.for_each_chunk(f_.runner, inputs, [&](const PairInputs& in, auto chunk) {
    sums_.response(in, chunk, all);
    for (const TargetCluster& cluster : chunk) {
      for (Index s = cluster.begin; s < cluster.end; ++s) {
        const Index i = order_[s];
        const LiquidModel& liquid = liquid_of(model, i);
        const Real factor = gradient_factor(model, liquid);
        const Real* const sums = all + kResponseSums * std::size_t{s};
        const Real gradient2 = factor * factor * Eigen::Map<const Vec3>(sums).squaredNorm();
        const Real squares = factor * factor * scale * sums[3];
        const Real solids = factor * sums[4];
        const Real volume = model.rest_volume[i];
        diagonal[s] = volume * (mobility_of_liquid(i) * gradient2 + volume * squares) +
                      volume * volume * liquid.slope_scale * solids * solids;
      }
    }
  });
}

}  // namespace vat
