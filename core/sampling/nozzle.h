#pragma once

#include <cstdint>
#include <vector>

#include "core/scene/scene.h"

namespace vat {

/// An emitter's stream as layers of particles one after the other, a spacing apart, each a square
/// lattice centred on the opening.
struct Nozzle {
  std::vector<Vec3> layer;       ///< places of a layer's particles as it passes the opening [m]
  Vec3 velocity = Vec3::Zero();  ///< [m/s]
  Real mass = 0;                 ///< of a particle at rest density [kg]; in the plane [kg/m]
  Real interval = 0;             ///< from one layer to the next [s]
  std::uint64_t inside = 0;      ///< layers that the tube holds
  Real from = 0;                 ///< when the first layer passes the opening [s]
  std::uint64_t layers = 0;      ///< how many there will be

  /// How many layers have come into the tube by a time [s].
  std::uint64_t entered(Real time) const;
  /// How far a layer is beyond the opening [s]; negative within the tube.
  Real age(std::uint64_t layer_index, Real time) const {
    return time - from - interval * static_cast<Real>(layer_index);
  }
};

/// Places of a layer of the emitter: how many there would be at most, and themselves.
Real lattice_points(const Emitter& emitter, Real spacing, int dimensions);
std::vector<Vec3> layer_of(const Emitter& emitter, Real spacing, int dimensions);

/// Of a valid emitter of a valid scene.
Nozzle make_nozzle(const Scene& scene, const Emitter& emitter);

/// The greatest number of particles that emitters let a body have; 0 where none feeds it.
std::size_t most_particles(const Scene& scene, const BodyDescription& body);

}  // namespace vat
