#pragma once

#include <cstddef>

#include "core/types.h"

/// Limits of all quantities of a scene that a client can increase, with their reasons. The limits
/// of clients and messages are in server/messages/limits.h.
namespace vat {

inline constexpr std::size_t kMaxParticles =
    1'000'000;  // memory: up to 2 kB for each with its pairs
inline constexpr std::size_t kMaxSprings =
    4'000'000;                                    // 13 for each particle of a lattice, and a margin
inline constexpr std::size_t kMaxBodies = 4096;   // size of the per-body blocks of a frame
inline constexpr std::size_t kMaxMaterials = 64;  // size of the interface table, which is quadratic
inline constexpr std::size_t kMaxNameLength = 64;    // names are shown to other users
inline constexpr std::size_t kMaxTextLength = 4096;  // title and description
inline constexpr std::size_t kMaxWaves = 64;         // of one field: each particle sums over them
inline constexpr std::size_t kMaxMeshTriangles = 200'000;    // memory, and time of validation
inline constexpr std::size_t kMaxMeshWork = 20'000'000;      // pairs of triangle and lattice column
inline constexpr std::size_t kMaxLatticePoints = 8'000'000;  // of the bounding boxes of all shapes
inline constexpr std::size_t kMaxSceneTriangles = 1'000'000;  // of all meshes: time of validation
inline constexpr std::size_t kMaxStepsPerTick = 10'000;       // duration of a tick
inline constexpr std::size_t kMaxEmitters = 64;               // each step visits all
inline constexpr std::size_t kMaxDrains = 64;          // each step compares each particle with all
inline constexpr std::size_t kMaxGrabs = 64;           // of all users of a simulation
inline constexpr std::size_t kMaxAppliedForces = 256;  // timed forces that have not ended

// Lengths in units of the spacing of sampled bodies. Longer ones give a particle over 2000
// neighbours, without a better result than a hundred.
inline constexpr Real kMaxReachInSpacings = 8;   // support radius, contact threshold
inline constexpr Real kMaxRadiusInSpacings = 4;  // particle radius: two radii make the reach

/// The minimum support radius with surface tension, in spacings. With a smaller one, curvature is
/// noise, and particles that attract each other stay on a lattice.
inline constexpr Real min_surface_support(bool is_cohesive) {
  return is_cohesive ? 3 : 2.5;
}

/// The maximum number of entries in the neighbour lists of `particles` liquid particles: 256 for
/// each (1 kB), and at least 16 million. A pair has two entries. A step with more fails.
constexpr std::size_t max_pairs(std::size_t particles) {
  const std::size_t by_particle = 256 * particles;
  return by_particle > 16'000'000 ? by_particle : 16'000'000;
}
/// The maximum pair work of coupled liquids: particles times the particles near their cell. At
/// least a quarter of these are within the support radius.
constexpr std::size_t max_pair_work(std::size_t particles) {
  return 4 * max_pairs(particles);
}
/// The maximum number of entries at the start of a scene, and of contacts. It leaves room for
/// compression.
constexpr std::size_t max_start_pairs(std::size_t particles) {
  return max_pairs(particles) / 2;
}
/// The maximum number of contacts by projection in one step, each with 400 bytes and 10 us. A step
/// with more fails.
inline constexpr std::size_t kMaxProjections = 500'000;
inline constexpr std::size_t kMaxSearch = 1'000'000'000;  // particles tested for one list of pairs

inline constexpr Real kMinLength = 1e-6;       // spacing, radius, extent [m]
inline constexpr Real kMaxLength = 1e6;        // coordinates and extents [m]
inline constexpr Real kMaxSpeed = 1e4;         // [m/s]; also the limit of the guard
inline constexpr Real kMinMass = 1e-12;        // [kg]
inline constexpr Real kMaxMass = 1e12;         // [kg]
inline constexpr Real kMaxForce = 1e12;        // of an applied force [N]
inline constexpr Real kMaxStiffness = 1e12;    // [N/m], [m^2/s^2]
inline constexpr Real kMaxDamping = 1e12;      // [N s/m]
inline constexpr Real kMaxFriction = 10;       // coefficient; rubber on rubber has 1 to 2
inline constexpr Real kMinRestitution = 0.05;  // of dashpots: damping ratio 2.2
inline constexpr Real kMinLayerReach =
    1.1;  // in thresholds; the stiffness rises for smaller reaches
inline constexpr Real kMaxLayerReach =
    4;  // in thresholds: the number of neighbours grows with its cube
inline constexpr Real kMinStrain = 1e-6;        // at which springs tear
inline constexpr Real kMaxStrain = 1e3;         // at which springs tear or yield
inline constexpr Real kMaxPlasticStrain = 0.9;  // a spring must keep a length
inline constexpr Real kMaxHardening = 1e3;      // plastic modulus / stiffness
inline constexpr Real kMinDensity = 1e-6;       // [kg/m^3]
inline constexpr Real kMaxDensity = 1e9;        // [kg/m^3]
inline constexpr Real kMaxViscosity = 1e9;      // [Pa s]
inline constexpr Real kMaxGravity = 1e3;        // [m/s^2]
inline constexpr Real kMaxAngularSpeed = 1e4;   // [rad/s]; also of the central field
inline constexpr Real kMaxGradient = 1e9;       // of a field [1/s], or dimensionless
inline constexpr Real kMaxWaveNumber = 1e9;     // [rad/m]
inline constexpr Real kMaxPhase = 1e3;          // [rad]
inline constexpr Real kMaxJitter = 0.5;         // in spacings: neighbours keep their order
inline constexpr Real kMaxDrag = 1e6;           // of settling liquids [1/s]
inline constexpr Real kMaxRelease = 1e9;        // of a held body, and end of settling [s]
inline constexpr Real kMinSleepSpeed = 1e-9;    // at which bodies fall asleep [m/s]
inline constexpr Real kMaxSleepSpeed = 1;       // [m/s]; faster bodies do not appear to rest
inline constexpr Real kMaxSleepAfter = 3600;    // duration of rest before sleep [s]
inline constexpr Real kMinPeriod = 1e-3;        // of the motion of the vat [s]
inline constexpr Real kMaxPeriod = 1e6;         // [s]
inline constexpr Real kMaxForceTime = 3600;     // of an applied force [s]
inline constexpr Real kMaxHandSpeed = 1;        // of a vat that users move [m/s]
inline constexpr Real kMaxHandAcceleration =
    5;  // of a vat that users move [m/s^2]: tilts a surface by 27 degrees
inline constexpr Real kMinStep = 1e-7;              // [s]
inline constexpr Real kMaxStep = 0.1;               // [s]
inline constexpr Real kMaxTick = 1.0;               // [s]
inline constexpr Real kMaxArtificialViscosity = 1;  // alpha
inline constexpr Real kMaxSurfaceTension = 1e6;     // [N/m]
inline constexpr Real kMinContactAngle = 30;        // of cohesive liquids [degrees]
inline constexpr Real kMaxContactAngle = 135;
inline constexpr Real kMinAccuracy = 1e-8;  // also of a tolerance: rounding is not far below
inline constexpr Real kMaxAccuracy = 0.1;   // error models hold for small errors
inline constexpr Real kMaxTolerance = 1;    // beyond it, only stability limits steps
inline constexpr Real kMinVolumeTolerance = 1e-10;  // of densities: rounding is not far below
inline constexpr Real kMaxVolumeTolerance = 0.1;
inline constexpr int kMinIterations = 2;      // of a solve: the first, and a correction
inline constexpr int kMaxIterations = 10000;  // a step must end
inline constexpr int kMaxStepLevel = 10;      // halvings of a step: a nominal step must end

}  // namespace vat
