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

/// Eight neighbours of a lattice. Corner c is at the upper end of the cell along x if bit 0 of c is
/// set, along y for bit 1, and along z for bit 2. In two dimensions there are four, with bit 0 for
/// x and bit 1 for z.
struct SampledCell {
  std::array<Index, 8> corners{};
  Real volume = 0;  ///< at rest [m^3], in two dimensions area [m^2]
};

/// A particle that has not left the tube of its nozzle.
struct NozzleParticle {
  Index particle = 0;
  std::uint64_t free_from = 0;  ///< the first nominal step in which forces move it
};

/// Particles of a body in world coordinates at time 0. The columns of particles have equal lengths.
struct SampledBody {
  std::vector<Vec3> positions;
  std::vector<Vec3> velocities;
  std::vector<Real> masses;
  std::vector<Real> radii;
  std::vector<Index> fixed;
  std::vector<SampledSpring> springs;
  std::vector<SampledCell> cells;            ///< if the material has a bulk modulus
  std::vector<NozzleParticle> in_nozzles{};  ///< not moved by forces
  /// Numbers of the particles, which do not change. Empty if no particle has been removed; the
  /// numbers are then 0, 1, 2, ...
  std::vector<Index> numbers{};
  Index next_number = 0;  ///< number of the next particle; 0 if none was added or removed
};

/// Converts the description of a valid body into particles and springs, in an order that depends on
/// the description only. Shapes are filled with a simple cubic lattice of `spacing`, centred on the
/// bounding box; a particle belongs to the shape if its centre does. Solid bodies get mass =
/// density * exact volume of the shape in equal parts, or the given mass. A liquid particle gets
/// density * spacing^3, so that the lattice has the rest density. Springs have their rest lengths
/// after the jitter, and the displacement field stretches them. In two dimensions a square lattice
/// fills the section at y = 0, areas replace volumes, and masses are per metre [kg/m].
SampledBody sample_body(const BodyDescription& body, const Material& material, int dimensions = 3);

/// The maximum number of lattice springs that begin at one lattice point.
std::size_t springs_per_point(const LatticeSprings& springs);

/// All bodies of a valid scene.
std::vector<SampledBody> sample_bodies(const Scene& scene);

/// Pointers to the elements of `bodies`.
std::vector<const SampledBody*> pointers_to(const std::vector<SampledBody>& bodies);

/// Exact volume of a sampled shape [m^3]; zero for explicit particles.
Real shape_volume(const Shape& shape);

/// Exact area of the section at y = 0 [m^2] of a box or a sphere, the shapes of two-dimensional
/// scenes. Zero for other shapes.
Real shape_area(const Shape& shape);

}  // namespace vat
