#include "core/solid/springs.h"

#include "core/laws/connection.h"
#include "core/laws/pair_direction.h"
#include "core/solid/scratch.h"
#include "core/solid/spring_changes.h"
#include "core/solid/spring_sums.h"
#include "core/stage/context.h"
#include "core/state/state.h"
#include "core/support/check.h"

namespace vat {
namespace {

/// f = -(k (|p_e - p_i| - l) + c v_ei.n) n with n = (p_e - p_i) / |p_e - p_i|.      Boldt eq. 3
template <bool keep_directions, bool springs_change>
void add_block(StepContext& c, Index begin, Index end) {
  const SpringEnd* const ends = c.model.spring_ends.data();
  const Vec3* const positions = c.configuration.position.data();
  const Vec3* const velocities = c.configuration.velocity.data();
  Vec3* const directions = c.work.of<SolidScratch>().spring_directions.data();
  const int dimensions = c.model.scene.dimensions;
  const Model* const model = &c.model;
  const Configuration* const configuration = &c.configuration;
  BlockSums sums;
  sum_over_springs(c.model, begin, end, sums, [&](Index e) {
    return [=, position = positions[e], velocity = velocities[e]](Index s) -> Vec3 {
      const SpringEnd& spring = ends[s];
      const Vec3 x = position - positions[spring.other];
      const Real r = x.norm();
      const Vec3 n = r > 0 ? Vec3(x * (1 / r)) : coincident_direction(e, spring.other, dimensions);
      const Real speed = (velocity - velocities[spring.other]).dot(n);
      if constexpr (springs_change) {
        const SpringEnd now = present_spring(*model, *configuration, s);
        // Torn springs have no damping, and their direction is zero.
        if constexpr (keep_directions) directions[s] = now.damping > 0 ? n : Vec3(Vec3::Zero());
        return connection_push(now.stiffness, now.damping, now.rest_length, r, speed) * n;
      } else {
        if constexpr (keep_directions) directions[s] = n;
        return connection_push(spring.stiffness, spring.damping, spring.rest_length, r, speed) * n;
      }
    };
  });
  for (Index e = begin; e < end; ++e) c.forces.particle[e] += sums[e - begin];
}

template <bool keep_directions>
void add_springs(StepContext& c) {
  for_spring_blocks(c.model, c.runner, [&](Index begin, Index end) {
    c.configuration.springs.empty() ? add_block<keep_directions, false>(c, begin, end)
                                    : add_block<keep_directions, true>(c, begin, end);
  });
}

}  // namespace

void add_spring_forces(StepContext& c) {
  VAT_CHECK(c.forces.particle.size() == c.model.particle_count);
  if (c.work.keep_dampers)
    c.work.of<SolidScratch>().spring_directions.resize(c.model.spring_ends.size());
  c.work.keep_dampers ? add_springs<true>(c) : add_springs<false>(c);
}

}  // namespace vat
