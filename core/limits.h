#pragma once

#include <cstddef>

#include "core/types.h"

/// Every cap on what a scene can make grow, with the reason. The server has its own limits on
/// clients and messages in server/messages/limits.h.
namespace vat {

inline constexpr std::size_t kMaxParticles = 1'000'000;  // memory: up to 2 kB each with its pairs
inline constexpr std::size_t kMaxSprings = 4'000'000;    // 13 per particle of a lattice, and slack
inline constexpr std::size_t kMaxBodies = 4096;          // the frame's per-body blocks stay small
inline constexpr std::size_t kMaxMaterials = 64;         // the interface table is quadratic in it
inline constexpr std::size_t kMaxNameLength = 64;        // names are shown to other users
inline constexpr std::size_t kMaxTextLength = 4096;      // title and description
inline constexpr std::size_t kMaxWaves = 64;             // of one field: each particle sums them
inline constexpr std::size_t kMaxMeshTriangles = 200'000;    // memory and time to check it
inline constexpr std::size_t kMaxMeshWork = 20'000'000;      // pairs of triangle and lattice column
inline constexpr std::size_t kMaxLatticePoints = 8'000'000;  // of all shapes' bounding boxes
inline constexpr std::size_t kMaxSceneTriangles = 1'000'000;  // of all meshes, time to check them
inline constexpr std::size_t kMaxStepsPerTick = 10'000;       // a tick must end
inline constexpr std::size_t kMaxEmitters = 64;               // each step asks all of them
inline constexpr std::size_t kMaxDrains = 64;                 // each particle is sought in all
inline constexpr std::size_t kMaxGrabs = 64;                  // of one simulation, by all users
inline constexpr std::size_t kMaxAppliedForces = 256;         // pending timed forces

// Lengths over the spacing of sampled bodies: beyond them a particle has over 2000 neighbours, and
// sums over so many are no better than over a hundred.
inline constexpr Real kMaxReachInSpacings = 8;   // support radius, contact threshold
inline constexpr Real kMaxRadiusInSpacings = 4;  // particle radius: two of them make the reach

/// Support radius with surface tension, in spacings: with less, curvature is noise, and particles
/// that attract each other lie as on a lattice.
inline constexpr Real min_surface_support(bool is_cohesive) {
  return is_cohesive ? 3 : 2.5;
}

/// Entries in the neighbour lists of `particles` liquid particles, a pair counting twice: 256 each,
/// 1 kB, or 16 million where that is more. Beyond them a step fails.
constexpr std::size_t max_pairs(std::size_t particles) {
  const std::size_t by_particle = 256 * particles;
  return by_particle > 16'000'000 ? by_particle : 16'000'000;
}
/// Of coupled liquids: particles times what is near their cell, of which a quarter or more is
/// within their support.
constexpr std::size_t max_pair_work(std::size_t particles) {
  return 4 * max_pairs(particles);
}
/// The same for a scene at its start, and of contacts: it must have room to be compressed.
constexpr std::size_t max_start_pairs(std::size_t particles) {
  return max_pairs(particles) / 2;
}
/// Contacts by projection of one step, which must end: 400 bytes and 10 us each. A step with more
/// fails.
inline constexpr std::size_t kMaxProjections = 500'000;
inline constexpr std::size_t kMaxSearch = 1'000'000'000;  // particles tried for one list of pairs

inline constexpr Real kMinLength = 1e-6;            // [m] spacing, radius, extent
inline constexpr Real kMaxLength = 1e6;             // [m] coordinates and extents
inline constexpr Real kMaxSpeed = 1e4;              // [m/s] also the guard's bound
inline constexpr Real kMinMass = 1e-12;             // [kg]
inline constexpr Real kMaxMass = 1e12;              // [kg]
inline constexpr Real kMaxForce = 1e12;             // [N] of an applied force
inline constexpr Real kMaxStiffness = 1e12;         // [N/m], [m^2/s^2]
inline constexpr Real kMaxDamping = 1e12;           // [N s/m]
inline constexpr Real kMaxFriction = 10;            // coefficient; rubber on rubber has 1 to 2
inline constexpr Real kMinRestitution = 0.05;       // of dashpots: damping ratio 2.2
inline constexpr Real kMinLayerReach = 1.1;         // thresholds; stiffness rises as it falls
inline constexpr Real kMaxLayerReach = 4;           // thresholds: neighbours grow as its cube
inline constexpr Real kMinStrain = 1e-6;            // at which springs tear
inline constexpr Real kMaxStrain = 1e3;             // at which they tear, or yield
inline constexpr Real kMaxPlasticStrain = 0.9;      // a spring keeps a length
inline constexpr Real kMaxHardening = 1e3;          // plastic modulus over stiffness
inline constexpr Real kMinDensity = 1e-6;           // [kg/m^3]
inline constexpr Real kMaxDensity = 1e9;            // [kg/m^3]
inline constexpr Real kMaxViscosity = 1e9;          // [Pa s]
inline constexpr Real kMaxGravity = 1e3;            // [m/s^2]
inline constexpr Real kMaxAngularSpeed = 1e4;       // [rad/s], and of the central field
inline constexpr Real kMaxGradient = 1e9;           // [1/s] or a pure number, of a field
inline constexpr Real kMaxWaveNumber = 1e9;         // [rad/m]
inline constexpr Real kMaxPhase = 1e3;              // [rad]
inline constexpr Real kMaxJitter = 0.5;             // of a spacing: neighbours keep their order
inline constexpr Real kMaxDrag = 1e6;               // [1/s] while liquids settle
inline constexpr Real kMaxRelease = 1e9;            // [s] of a held body, and end of settling
inline constexpr Real kMinSleepSpeed = 1e-9;        // [m/s] at which bodies fall asleep
inline constexpr Real kMaxSleepSpeed = 1;           // [m/s] above it nothing would seem at rest
inline constexpr Real kMaxSleepAfter = 3600;        // [s] of rest before it
inline constexpr Real kMinPeriod = 1e-3;            // [s] of the vat's motion
inline constexpr Real kMaxPeriod = 1e6;             // [s]
inline constexpr Real kMaxForceTime = 3600;         // [s] of an applied force
inline constexpr Real kMaxHandSpeed = 1;            // [m/s] at which a hand moves the vat, and
inline constexpr Real kMaxHandAcceleration = 5;     // [m/s^2]: a surface tilts by 27 degrees
inline constexpr Real kMinStep = 1e-7;              // [s]
inline constexpr Real kMaxStep = 0.1;               // [s]
inline constexpr Real kMaxTick = 1.0;               // [s]
inline constexpr Real kMaxArtificialViscosity = 1;  // alpha
inline constexpr Real kMaxSurfaceTension = 1e6;     // [N/m]
inline constexpr Real kMinContactAngle = 30;        // [degrees] of liquids that attract themselves
inline constexpr Real kMaxContactAngle = 135;
inline constexpr Real kMinAccuracy = 1e-8;  // of a tolerance too: rounding is not far below
inline constexpr Real kMaxAccuracy = 0.1;   // error models are for small errors
inline constexpr Real kMaxTolerance = 1;    // only stability and contacts unseen limit steps
inline constexpr Real kMinVolumeTolerance = 1e-10;  // of densities: rounding is not far below
inline constexpr Real kMaxVolumeTolerance = 0.1;
inline constexpr int kMinIterations = 2;      // of a solve: one, and one that takes back
inline constexpr int kMaxIterations = 10000;  // a step must end
inline constexpr int kMaxStepLevel = 10;      // halvings of a step: a nominal step must end

}  // namespace vat
