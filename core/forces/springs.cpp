#include "core/forces/springs.h"

#include "core/forces/connection.h"
#include "core/forces/pair_direction.h"
#include "core/forces/spring_changes.h"
#include "core/step/workspace.h"

namespace vat {
namespace {

// f = -(k (|p_e - p_i| - l) + c v_ei.n) n with n = (p_e - p_i) / |p_e - p_i|.      Boldt eq. 3
Vec3 spring_force(const Configuration& at, Index e, const SpringEnd& spring, int dimensions,
                  Vec3* direction) {
  const Vec3 x = at.position[e] - at.position[spring.other];
  const Real r = x.norm();
  const Vec3 n = pair_direction(x, r, e, spring.other, dimensions);
  // Those of torn springs are not asked for a damping that they no longer have.
  if (direction != nullptr) *direction = spring.damping > 0 ? n : Vec3(Vec3::Zero());
  const Real speed = (at.velocity[e] - at.velocity[spring.other]).dot(n);
  return connection_push(spring.stiffness, spring.damping, spring.rest_length, r, speed) * n;
}

}  // namespace

// Each spring is evaluated from both its ends: twice the arithmetic, but every particle's force has
// one writer, and the two are opposite to the bit.
void add_spring_forces(StepContext& c) {
  const Index first = c.model.liquid_count;
  const bool keep = c.work.keep_dampers;
  if (keep) c.work.spring_directions.resize(c.model.spring_ends.size());
  for_blocks(c.runner, c.model.implicit_begin - first, [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k) {
      const Index e = first + static_cast<Index>(k);
      Vec3 sum = Vec3::Zero();
      for (Index s = c.model.spring_begin[e]; s < c.model.spring_begin[e + 1]; ++s) {
        const SpringEnd spring = present_spring(c.model, c.configuration, s);
        sum += spring_force(c.configuration, e, spring, c.model.scene.dimensions,
                            keep ? &c.work.spring_directions[s] : nullptr);
      }
      c.forces.particle[e] += sum;
    }
  });
}

}  // namespace vat
