#pragma once

#include <array>
#include <vector>

#include "core/scene/scene.h"
#include "core/support/result.h"

namespace vat {

struct SampledSpring {
  Index a = 0;
  Index b = 0;
  Real stiffness = 0;    ///< [N/m]
  Real damping = 0;      ///< [N s/m]
  Real rest_length = 0;  ///< [m]
};

/// Eight neighbours of a lattice, in two dimensions four: corner c is at the cell's far end along x
/// where bit 0 of c is set, along y where bit 1 is, and along z where bit 2 is; of four along x and
/// z.
struct SampledCell {
  std::array<Index, 8> corners{};
  Real volume = 0;  ///< at rest [m^3], in two dimensions area [m^2]
};

/// A particle that has not left the tube of its nozzle.
struct NozzleParticle {
  Index particle = 0;
  std::uint64_t free_from = 0;  ///< the first nominal step in which forces move it
};

/// A body as particles in world coordinates at time 0; all columns have equal length.
struct SampledBody {
  std::vector<Vec3> positions;
  std::vector<Vec3> velocities;
  std::vector<Real> masses;
  std::vector<Real> radii;
  std::vector<Index> fixed;
  std::vector<SampledSpring> springs;
  std::vector<SampledCell> cells;            ///< where the material keeps their volume
  std::vector<NozzleParticle> in_nozzles{};  ///< that no force moves
  /// Of the particles, from their coming to their going: empty while none has gone, and they are
  /// 0, 1, 2, ... in their order.
  std::vector<Index> numbers{};
  Index next_number = 0;  ///< of the particle that comes next; 0 too while none has come or gone
};

/// Turns a body's description into particles and springs, in an order that depends on nothing but
/// the description. Sampled shapes are filled with a simple cubic lattice of `spacing`, centred on
/// the shape's bounding box; a particle belongs to the shape if its centre does. Solid bodies get
/// mass = density * exact volume of the shape in equal parts (or the given mass); a liquid particle
/// gets density * spacing^3 so that the lattice is at rest density. Springs are at rest where the
/// jitter leaves their ends, and stretched by the displacement field. In two dimensions a square
/// lattice fills the section at y = 0, and areas stand for volumes: masses are per metre [kg/m].
/// The body must be valid.
SampledBody sample_body(const BodyDescription& body, const Material& material, int dimensions = 3);

/// All bodies of a valid scene.
std::vector<SampledBody> sample_bodies(const Scene& scene);

/// Where each of `bodies` is.
std::vector<const SampledBody*> pointers_to(const std::vector<SampledBody>& bodies);

/// Exact volume of a sampled shape [m^3]; zero for explicit particles.
Real shape_volume(const Shape& shape);

/// Exact area of the section at y = 0 [m^2] of a shape that a scene of two dimensions may sample:
/// a box or a sphere. Zero for others.
Real shape_area(const Shape& shape);

}  // namespace vat
