#pragma once

#include <vector>

#include "core/contact/contact_list.h"
#include "core/numerics/stable_step.h"
#include "core/stage/scratch.h"
#include "core/types.h"

namespace vat {

/// Sums of the constants of the contacts of a particle. A contact counts twice if the other end is
/// not fixed.
struct ContactLoad {
  Real stiffness = 0;  ///< [N/m]
  Real damping = 0;    ///< [N s/m]
};

/// A damper between particle i and another particle or a wall j, with the force f_i = -strength
/// ((w_i - w_j).n) n for the velocities w.
struct Damper {
  Index other;     ///< kNoParticle: a wall
  Real strength;   ///< [N s/m]
  Vec3 direction;  ///< n
};

/// A friction damper perpendicular to the normal n, with the force f_i = -strength (1 - n n^T) (u_i
/// - u_j) at the friction point. The velocity of a body at this point is u = w + omega x arm.
struct FrictionDamper {
  Index other;     ///< kNoParticle: a wall
  Real strength;   ///< [N s/m]
  Vec3 normal;     ///< n
  Vec3 arm;        ///< from the particle's centre to the friction point [m]
  Vec3 other_arm;  ///< from the other particle's centre to the friction point [m]
};

/// The dampers of one block of particles. Each row is for one particle with dampers. The dampers of
/// a row begin at the ends of the preceding row.
struct DamperBlock {
  struct Row {
    Index particle;
    Index damper_end;
    Index friction_end;
  };
  std::vector<Row> rows;
  std::vector<Damper> dampers;
  std::vector<FrictionDamper> friction_dampers;

  void clear() {
    rows.clear();
    dampers.clear();
    friction_dampers.clear();
  }
  /// Adds a row for `particle` with all dampers added since the last call of close().
  void close(Index particle) {
    const std::size_t dampers_before = rows.empty() ? 0 : rows.back().damper_end;
    const std::size_t friction_dampers_before = rows.empty() ? 0 : rows.back().friction_end;
    if (dampers.size() == dampers_before && friction_dampers.size() == friction_dampers_before)
      return;
    rows.push_back({particle, static_cast<Index>(dampers.size()),
                    static_cast<Index>(friction_dampers.size())});
  }
};

/// Buffers of the contacts between particles and with walls.
struct ContactForceScratch {
  static constexpr Method kMethod = Method::contact;

  bool too_many_contacts = false;  ///< more contacts than kMaxProjections; none is projected
  ContactList contacts;
  std::vector<Vec3> spins;                   ///< by rigid body; only with friction [rad/s]
  std::vector<ContactLoad> contact_loads;    ///< by particle; empty without contacts
  std::vector<Oscillation> load_bounds;      ///< by block of particles
  std::vector<Vec3> mobilities;              ///< see restitution.h; by particle [1/kg]
  std::vector<DamperBlock> contact_dampers;  ///< if Scratch::keep_dampers
  std::vector<DamperBlock> wall_dampers;
};

}  // namespace vat
