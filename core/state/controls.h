#pragma once

#include <cstdint>
#include <vector>

#include "core/types.h"

namespace vat {

/// A particle tied to a target by a damped spring. The held particles share its force.
struct Grab {
  std::uint64_t id = 0;
  BodyId body_id = 0;
  Index body = 0;           ///< index into Model::bodies
  Index particle = 0;       ///< within the body
  std::vector<Index> held;  ///< within the body; includes `particle`
  Vec3 target = Vec3::Zero();
  Real stiffness = 0;  ///< [N/m]
  Real damping = 0;    ///< [N s/m]
  Real max_force = 0;  ///< [N]
  Real held_mass = 0;  ///< [kg]
};

/// An equal acceleration of all particles of a body. It is constant over whole steps, so that its
/// impulse is equal for all integrators.
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
