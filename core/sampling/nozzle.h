#pragma once

#include <cstdint>
#include <vector>

#include "core/scene/scene.h"

namespace vat {

/// Flow of an emitter as a sequence of particle layers, one spacing apart. Each layer is a square
/// lattice centred on the opening.
struct Nozzle {
  std::vector<Vec3> layer;       ///< positions of the particles of a layer at the opening [m]
  Vec3 velocity = Vec3::Zero();  ///< [m/s]
  Real mass = 0;                 ///< of a particle at rest density [kg]; in two dimensions [kg/m]
  Real interval = 0;             ///< time between successive layers [s]
  std::uint64_t inside = 0;      ///< number of layers in the tube
  Real from = 0;                 ///< time at which the first layer passes the opening [s]
  std::uint64_t layers = 0;      ///< total number of layers

  /// Returns the number of layers that have entered the tube before or at `time` [s].
  std::uint64_t entered(Real time) const;
  /// Returns the time since a layer passed the opening [s]. The result is negative within the tube.
  Real age(std::uint64_t layer_index, Real time) const {
    return time - from - interval * static_cast<Real>(layer_index);
  }
};

/// lattice_points() returns an upper bound of the number of particles in a layer of the emitter.
/// layer_of() returns the positions of the particles of a layer.
Real lattice_points(const Emitter& emitter, Real spacing, int dimensions);
std::vector<Vec3> layer_of(const Emitter& emitter, Real spacing, int dimensions);

/// Returns the nozzle of an emitter of a valid scene.
Nozzle make_nozzle(const Scene& scene, const Emitter& emitter);

/// Returns the maximum number of particles of a body with emitters, and 0 for a body without
/// emitters.
std::size_t most_particles(const Scene& scene, const BodyDescription& body);

}  // namespace vat
