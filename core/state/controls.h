#pragma once

#include <cstdint>
#include <vector>

#include "core/types.h"

namespace vat {

/// A damped spring between a particle and a target. The force of the spring is distributed over the
/// particles in `held`.
struct Grab {
  std::uint64_t id = 0;
  BodyId body_id = 0;
  Index body = 0;           ///< index into Model::bodies
  Index particle = 0;       ///< index within the body
  std::vector<Index> held;  ///< indices within the body; includes `particle`
  Vec3 target = Vec3::Zero();
  Real stiffness = 0;  ///< [N/m]
  Real damping = 0;    ///< [N s/m]
  Real max_force = 0;  ///< [N]
  Real held_mass = 0;  ///< [kg]
};

/// An equal acceleration of all particles of a body. The acceleration is constant over whole
/// nominal steps, so that its impulse is equal for all integrators.
struct AppliedForce {
  BodyId body_id = 0;
  Index body = 0;  ///< index into Model::bodies
  Vec3 acceleration = Vec3::Zero();
  std::uint64_t end_step = 0;  ///< the first nominal step without the force
};

/// The actions of users on a simulation, in addition to its scene.
struct Controls {
  std::vector<Grab> grabs;
  std::vector<AppliedForce> applied_forces;
};

}  // namespace vat
