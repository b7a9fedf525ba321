#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "core/forces/contact_list.h"
#include "core/neighbours/periodic_box.h"
#include "core/neighbours/uniform_grid.h"
#include "core/pairs/pair_sources.h"
#include "core/state/state.h"
#include "core/step/controls.h"
#include "core/support/instruction_set.h"
#include "core/support/parallel.h"

namespace vat {

/// Points of one kind in cell order, coordinates in columns of their own so that a compiler can
/// vectorise distance tests over a run of slots.
struct CellSortedPoints {
  UniformGrid grid;
  std::vector<Real> x;
  std::vector<Real> y;
  std::vector<Real> z;
  std::vector<Vec3> wrapped;  ///< the points themselves, in their order; periodic worlds only
  std::uint64_t version = 0;  ///< rises whenever the points are other ones
  bool is_whole = false;      ///< false while they are sorted, or where that failed

  /// `cell_size`: best the search radius [m]. In a periodic world the coordinates are those of the
  /// images in the box.
  void build(std::span<const Vec3> points, Real cell_size, const PeriodicBox& periodic,
             TaskRunner* runner = nullptr);
  /// The same, but nothing is done where the points are those of the last time, to the bit.
  void update(std::span<const Vec3> points, Real cell_size, const PeriodicBox& periodic,
              TaskRunner* runner);
};

/// What a pressure or viscosity pair reads of a liquid particle, one cache line.
struct LiquidRecord {
  Vec3 position;
  Real volume;  ///< m / rho [m^3]
  Vec3 velocity;
  Real pressure;  ///< [Pa]
};

/// What surface tension sees of a liquid particle; see core/forces/surface_tension.h.
struct SurfaceRecord {
  Vec3 gradient;  ///< g [1/m]
  Real lack;      ///< 1 - s, never below zero
};

/// Of one block of slots: sums of the forces of curvature and of what balances them, about the
/// origin.
struct SurfaceSum {
  Vec3 force = Vec3::Zero();          ///< [N]
  Vec3 torque = Vec3::Zero();         ///< [N m]
  Real share = 0;                     ///< sigma times surface [J]
  Vec3 moment = Vec3::Zero();         ///< share times x
  Mat3 second_moment = Mat3::Zero();  ///< share times x x^T

  SurfaceSum& operator+=(const SurfaceSum& other) {
    force += other.force;
    torque += other.torque;
    share += other.share;
    moment += other.moment;
    second_moment += other.second_moment;
    return *this;
  }
};

/// Neighbours of one block of liquid slots: those of the block's k-th slot are
/// [begin[k], begin[k + 1]) of `slots`. One buffer a block, so that blocks are filled side by side.
struct PairBlock {
  std::vector<Index> slots;
  std::array<Index, kBlockSize + 1> begin;
};

/// The constants of the contacts that act on a particle, one whose other end moves too twice.
struct ContactLoad {
  Real stiffness = 0;  ///< [N/m]
  Real damping = 0;    ///< [N s/m]
};

/// What dampers see of two particles, or of one and a wall: f_i = -strength ((w_i - w_j).n) n.
struct Damper {
  Index other;     ///< kNoParticle: a wall
  Real strength;   ///< [N s/m]
  Vec3 direction;  ///< n
};
inline constexpr Index kNoParticle = ~Index{0};

/// The same of friction, across the normal n at the point of contact:
/// f_i = -strength (1 - n n^T) (u_i - u_j) with u = w + omega x arm.
struct RubDamper {
  Index other;     ///< kNoParticle: a wall
  Real strength;   ///< [N s/m]
  Vec3 normal;     ///< n
  Vec3 arm;        ///< from the particle's centre to the point [m]
  Vec3 other_arm;  ///< and from the other's
};

/// Dampers of those particles of one block that have any: of each, those after the ones before.
struct DamperBlock {
  struct Row {
    Index particle;
    Index damper_end;
    Index rub_end;
  };
  std::vector<Row> rows;
  std::vector<Damper> dampers;
  std::vector<RubDamper> rubs;

  void clear() {
    rows.clear();
    dampers.clear();
    rubs.clear();
  }
  /// What was added since the last call is of this particle.
  void close(Index particle) {
    const std::size_t dampers_before = rows.empty() ? 0 : rows.back().damper_end;
    const std::size_t rubs_before = rows.empty() ? 0 : rows.back().rub_end;
    if (dampers.size() == dampers_before && rubs.size() == rubs_before) return;
    rows.push_back({particle, static_cast<Index>(dampers.size()), static_cast<Index>(rubs.size())});
  }
};

/// How s of a liquid particle changes with its own place, and with others'.
struct VolumeSlope {
  Vec3 gradient;  ///< sum_j a_j g x of PairSums
  Real squares;   ///< sum_j a_j g^2 q^2
};

/// Scratch of force evaluations, kept from one to the next so that nothing is allocated in a steady
/// step. Nothing here outlives an evaluation in meaning, but lists that tell when they are out of
/// date.
struct Workspace {
  InstructionSet instructions = InstructionSet::baseline;  ///< of the vectorised loops
  CellSortedPoints liquid;
  // Of coupled liquids.
  PairSources sources;
  PairClusters liquid_clusters;            ///< pairs of liquid and all sources
  PairClusters solid_clusters;             ///< pairs of solids and liquid with its images
  std::uint64_t pairs_version = 0;         ///< of the sources that these were found among
  std::vector<VolumeSlope> volume_slopes;  ///< by liquid slot, of an incompressible liquid
  std::vector<PairViscosity> viscosities;  ///< by source, where liquids differ
  std::vector<Real> target_viscosities;    ///< by target, the same
  // Of the gas, and of coupled liquids where a stage asks for them.
  std::vector<LiquidRecord> liquid_records;  ///< by slot
  std::vector<PairBlock> liquid_pairs;
  bool too_many_pairs = false;  ///< above max_pairs(): the lists are not whole, a density is a NaN
  bool too_many_contacts = false;     ///< by projection, above kMaxProjections: none was solved for
  std::vector<Real> density;          ///< by liquid particle [kg/m^3]
  std::uint64_t density_version = 0;  ///< of the sources that it was summed over
  /// The same with all of the space beyond no-slip walls filled with the liquid at rest density.
  std::vector<Real> filled_density;
  std::vector<Real> filling;           ///< by liquid slot: density over filled density
  std::vector<Real> pressure;          ///< by liquid particle [Pa]
  std::vector<SurfaceRecord> surface;  ///< by liquid slot, as the next
  std::vector<Vec3> surface_normals;   ///< of length 1, inwards; zero away from the surface
  std::vector<Vec3> surface_forces;    ///< of its curvature [N]
  std::vector<SurfaceSum> surface_sums;
  // Solids in a weakly compressible liquid: their slots near those of the liquid, and the reverse.
  CellSortedPoints solids_in_liquid;  ///< index 0 is the first solid particle
  std::vector<PairBlock> solids_of_liquid;
  std::vector<PairBlock> liquid_of_solids;
  std::vector<Real> solid_pressure;  ///< by slot of solids_in_liquid [Pa]
  ContactList contacts;
  std::vector<Vec3> spins;                 ///< by rigid body, where there is friction [rad/s]
  std::vector<ContactLoad> contact_loads;  ///< by particle; empty where nothing touches
  std::vector<Oscillation> load_bounds;    ///< by block of particles
  std::vector<Vec3> yieldings;             ///< see core/forces/restitution.h; by particle [1/kg]
  std::vector<Real> cell_pressure;         ///< by cell [Pa]
  bool keep_dampers = false;               ///< asks for the next three lines
  std::vector<Vec3> spring_directions;     ///< n of Boldt eq. 3, by end that its block asked for
  std::vector<DamperBlock> contact_dampers;
  std::vector<DamperBlock> wall_dampers;
};

/// What a stage sees.
struct StepContext {
  const Model& model;
  const Controls& controls;
  Real time;           ///< [s]
  std::uint64_t step;  ///< the nominal step being taken
  Configuration& configuration;
  Forces& forces;
  Workspace& work;
  TaskRunner* runner;
};

}  // namespace vat
