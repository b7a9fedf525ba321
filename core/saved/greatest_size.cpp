#include "core/saved/greatest_size.h"

#include <algorithm>
#include <limits>

#include "core/limits.h"

namespace vat {
namespace {

constexpr std::size_t kReal = sizeof(Real);
constexpr std::size_t kVector = 3 * kReal;
constexpr std::size_t kIndex = sizeof(Index);

// Bytes of a particle: position, velocity, mass and radius, its index if it is fixed or numbered,
// and the time at which it leaves its nozzle.
constexpr std::size_t kDescribed = 2 * kVector + 2 * kReal + kIndex;
constexpr std::size_t kSampled = kDescribed + kIndex + sizeof(std::uint64_t);
constexpr std::size_t kConfigured = 2 * kVector + kReal;  // including pressure
constexpr std::size_t kForces = 2 * kVector + 1;          // including transport and level
constexpr std::size_t kHeld = kMaxGrabs * kIndex;
// A configuration is stored at most twice.
constexpr std::size_t kParticleBytes = kDescribed + kSampled + 2 * kConfigured + kForces + kHeld;

constexpr std::size_t kSpringDescribed = 2 * kIndex + 3 * kReal;
constexpr std::size_t kSpringBytes = kSpringDescribed + 2 * 2 * (kReal + 1);  // at each of its ends

constexpr std::size_t kContact = kIndex + sizeof(std::uint64_t) + 2 * kVector + 1;
constexpr std::size_t kTriangle = 3 * kIndex + 3 * kVector;
constexpr std::size_t kField = 4 * kVector + kMaxWaves * (2 * kVector + kReal);
constexpr std::size_t kBody = 2 * kField + kMaxNameLength + 1024;  // other fields are a few numbers
constexpr std::size_t kScene = std::size_t{1} << 20;  // materials, and interfaces of all pairs
constexpr std::size_t kAllElse =
    2 * kMaxProjections * kContact + kMaxSceneTriangles * kTriangle + kMaxBodies * kBody + kScene;

std::size_t times(std::size_t count, std::size_t bytes) {
  return std::min(count, std::numeric_limits<std::size_t>::max() / 4 / bytes) * bytes;
}

}  // namespace

std::size_t greatest_saved_size(std::size_t particles, std::size_t springs) {
  return kAllElse + times(particles, kParticleBytes) + times(springs, kSpringBytes);
}

}  // namespace vat
