#pragma once

#include <cstddef>

#include "core/types.h"

/// Limits of all quantities of a scene that a client can increase, with the reason for each limit.
/// The limits for clients and messages are in server/messages/limits.h.
namespace vat {

inline constexpr std::size_t kMaxParticles = 1'000'000;  // memory: up to 2 kB each, including pairs
inline constexpr std::size_t kMaxSprings = 4'000'000;    // 13 per lattice particle, plus a margin
inline constexpr std::size_t kMaxBodies = 4096;   // size of the per-body blocks of a frame message
inline constexpr std::size_t kMaxMaterials = 64;  // size of the interface table, which is quadratic
inline constexpr std::size_t kMaxNameLength = 64;    // names are displayed to other users
inline constexpr std::size_t kMaxTextLength = 4096;  // length of title and description
inline constexpr std::size_t kMaxWaves = 64;  // waves of one field; each particle sums over all
inline constexpr std::size_t kMaxMeshTriangles = 200'000;  // memory and validation time
inline constexpr std::size_t kMaxMeshWork = 20'000'000;  // pairs of a triangle and a lattice column
inline constexpr std::size_t kMaxLatticePoints = 8'000'000;   // in the bounding boxes of all shapes
inline constexpr std::size_t kMaxSceneTriangles = 1'000'000;  // of all meshes: validation time
inline constexpr std::size_t kMaxStepsPerTick = 10'000;  // computing time of a tick (server period)
inline constexpr std::size_t kMaxEmitters = 64;          // each step processes all emitters
inline constexpr std::size_t kMaxDrains = 64;  // each step tests each particle against all drains
inline constexpr std::size_t kMaxGrabs = 64;   // grabs by all users of one simulation
inline constexpr std::size_t kMaxAppliedForces = 256;  // timed forces that are still active

// Lengths in units of the particle spacing of sampled bodies. Greater lengths cause over 2000
// neighbours for each particle, but results are not better than with 100 neighbours.
inline constexpr Real kMaxReachInSpacings = 8;   // support radius, contact threshold
inline constexpr Real kMaxRadiusInSpacings = 4;  // particle radius: the reach is two radii

/// Returns the minimum support radius of liquids with surface tension, in particle spacings. With a
/// smaller support radius, curvature is dominated by noise, and cohesive particles remain on a
/// lattice.
inline constexpr Real min_surface_support(bool is_cohesive) {
  return is_cohesive ? 3 : 2.5;
}

/// Returns the maximum number of entries in the neighbour lists of `particles` liquid particles:
/// 256 for each particle (1 kB), and at least 16 million. A pair has two entries. A step that
/// exceeds this number fails.
constexpr std::size_t max_pairs(std::size_t particles) {
  const std::size_t by_particle = 256 * particles;
  return by_particle > 16'000'000 ? by_particle : 16'000'000;
}
/// Returns the maximum pair work of coupled liquids: the number of pairs of a particle and a
/// particle near its cell. At least a quarter of these pairs are within the support radius.
constexpr std::size_t max_pair_work(std::size_t particles) {
  return 4 * max_pairs(particles);
}
/// Returns the maximum number of neighbour list entries at the start of a scene, and of contacts.
/// The limit is half of max_pairs(), because compression adds neighbours.
constexpr std::size_t max_start_pairs(std::size_t particles) {
  return max_pairs(particles) / 2;
}
/// The maximum number of contacts by projection in one step. Each contact needs 400 bytes and 10
/// us. A step that exceeds this number fails.
inline constexpr std::size_t kMaxProjections = 500'000;
inline constexpr std::size_t kMaxSearch = 1'000'000'000;  // particles tested for one list of pairs

inline constexpr Real kMinLength = 1e-6;       // spacing, radius, extent [m]
inline constexpr Real kMaxLength = 1e6;        // coordinates and extents [m]
inline constexpr Real kMaxSpeed = 1e4;         // [m/s]; the guard uses the same limit
inline constexpr Real kMinMass = 1e-12;        // [kg]
inline constexpr Real kMaxMass = 1e12;         // [kg]
inline constexpr Real kMaxForce = 1e12;        // applied force [N]
inline constexpr Real kMaxStiffness = 1e12;    // [N/m], [m^2/s^2]
inline constexpr Real kMaxDamping = 1e12;      // [N s/m]
inline constexpr Real kMaxFriction = 10;       // coefficient mu; rubber on rubber: 1 to 2
inline constexpr Real kMinRestitution = 0.05;  // of dashpots; corresponds to damping ratio 2.2
inline constexpr Real kMinLayerReach = 1.1;    // in thresholds; stiffness rises for smaller reaches
inline constexpr Real kMaxLayerReach = 4;      // in thresholds; neighbours grow as the cube of this
inline constexpr Real kMinStrain = 1e-6;       // minimum tearing strain
inline constexpr Real kMaxStrain = 1e3;        // maximum tearing or yield strain
inline constexpr Real kMaxPlasticStrain = 0.9;   // rest lengths must remain positive
inline constexpr Real kMaxHardening = 1e3;       // plastic modulus / stiffness
inline constexpr Real kMinDensity = 1e-6;        // [kg/m^3]
inline constexpr Real kMaxDensity = 1e9;         // [kg/m^3]
inline constexpr Real kMaxViscosity = 1e9;       // [Pa s]
inline constexpr Real kMaxGravity = 1e3;         // [m/s^2]
inline constexpr Real kMaxAngularSpeed = 1e4;    // [rad/s]; also for the central field
inline constexpr Real kMaxGradient = 1e9;        // gradient of a field [1/s] or dimensionless
inline constexpr Real kMaxWaveNumber = 1e9;      // [rad/m]
inline constexpr Real kMaxPhase = 1e3;           // [rad]
inline constexpr Real kMaxJitter = 0.5;          // in spacings; preserves the order of neighbours
inline constexpr Real kMaxDrag = 1e6;            // drag during settling of liquids [1/s]
inline constexpr Real kMaxRelease = 1e9;         // release of a held body, end of settling [s]
inline constexpr Real kMinSleepSpeed = 1e-9;     // minimum sleep threshold [m/s]
inline constexpr Real kMaxSleepSpeed = 1;        // [m/s]; faster bodies do not appear to rest
inline constexpr Real kMaxSleepAfter = 3600;     // duration of rest before sleep [s]
inline constexpr Real kMinPeriod = 1e-3;         // period of the motion of the vat [s]
inline constexpr Real kMaxPeriod = 1e6;          // [s]
inline constexpr Real kMaxForceTime = 3600;      // duration of an applied force [s]
inline constexpr Real kMaxHandSpeed = 1;         // vat moved by users [m/s]
inline constexpr Real kMaxHandAcceleration = 5;  // vat moved by users [m/s^2]; tilt of 27 degrees
inline constexpr Real kMinStep = 1e-7;           // [s]
inline constexpr Real kMaxStep = 0.1;            // [s]
inline constexpr Real kMaxTick = 1.0;            // [s]
inline constexpr Real kMaxArtificialViscosity = 1;  // alpha
inline constexpr Real kMaxSurfaceTension = 1e6;     // [N/m]
inline constexpr Real kMinContactAngle = 30;        // cohesive liquids [degrees]
inline constexpr Real kMaxContactAngle = 135;
inline constexpr Real kMinAccuracy = 1e-8;  // also for tolerances; limited by rounding errors
inline constexpr Real kMaxAccuracy = 0.1;   // error models are valid for small errors only
inline constexpr Real kMaxTolerance = 1;    // above it, only stability limits steps
inline constexpr Real kMinVolumeTolerance = 1e-10;  // of densities; limited by rounding errors
inline constexpr Real kMaxVolumeTolerance = 0.1;
inline constexpr int kMinIterations = 2;      // the first iteration and one correction
inline constexpr int kMaxIterations = 10000;  // bounds the duration of a step
inline constexpr int kMaxStepLevel = 10;      // halvings of a step: bounds its duration
inline constexpr std::uint32_t kMaxSubSteps = 1U << kMaxStepLevel;

}  // namespace vat
