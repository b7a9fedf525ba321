#pragma once

#include <vector>

#include "core/contact/contact_list.h"
#include "core/numerics/stable_step.h"
#include "core/stage/scratch.h"
#include "core/types.h"

namespace vat {

/// Sums of the constants of a particle's contacts. A contact counts twice if its other end moves.
struct ContactLoad {
  Real stiffness = 0;  ///< [N/m]
  Real damping = 0;    ///< [N s/m]
};

/// A damper between two particles, or a particle and a wall: f_i = -strength ((w_i - w_j).n) n.
struct Damper {
  Index other;     ///< kNoParticle: a wall
  Real strength;   ///< [N s/m]
  Vec3 direction;  ///< n
};

/// A friction damper, perpendicular to the normal n at the point of contact:
/// f_i = -strength (1 - n n^T) (u_i - u_j) with u = w + omega x arm.
struct FrictionDamper {
  Index other;     ///< kNoParticle: a wall
  Real strength;   ///< [N s/m]
  Vec3 normal;     ///< n
  Vec3 arm;        ///< from the particle's centre to the point [m]
  Vec3 other_arm;  ///< from the other particle's centre to the point [m]
};

/// The dampers of one block of particles. A row belongs to a particle with dampers: its dampers lie
/// between the ends of the preceding row and its own ends.
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
  /// Assigns the dampers added since the last call to this particle.
  void close(Index particle) {
    const std::size_t dampers_before = rows.empty() ? 0 : rows.back().damper_end;
    const std::size_t friction_dampers_before = rows.empty() ? 0 : rows.back().friction_end;
    if (dampers.size() == dampers_before && friction_dampers.size() == friction_dampers_before)
      return;
    rows.push_back({particle, static_cast<Index>(dampers.size()),
                    static_cast<Index>(friction_dampers.size())});
  }
};

/// Buffers of contacts and walls.
struct ContactForceScratch {
  static constexpr Method kMethod = Method::contact;

  bool too_many_contacts = false;  ///< more than kMaxProjections; no contact is projected then
  ContactList contacts;
  std::vector<Vec3> spins;                   ///< by rigid body, if there is friction [rad/s]
  std::vector<ContactLoad> contact_loads;    ///< by particle; empty without contacts
  std::vector<Oscillation> load_bounds;      ///< by block of particles
  std::vector<Vec3> mobilities;              ///< see restitution.h; by particle [1/kg]
  std::vector<DamperBlock> contact_dampers;  ///< if Scratch::keep_dampers
  std::vector<DamperBlock> wall_dampers;
};

}  // namespace vat
