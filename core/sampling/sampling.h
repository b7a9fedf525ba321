#pragma once

#include <array>
#include <vector>

#include "core/scene/scene.h"

namespace vat {

struct SampledSpring {
  Index a = 0;
  Index b = 0;
  Real stiffness = 0;    ///< [N/m]
  Real damping = 0;      ///< [N s/m]
  Real rest_length = 0;  ///< [m]
};

/// Cell of eight neighbouring lattice points. Corner c is at the upper end of the cell along x if
/// bit 0 of c is set, along y for bit 1, and along z for bit 2. In two dimensions, a cell has four
/// corners, with bit 0 for x and bit 1 for z.
struct SampledCell {
  std::array<Index, 8> corners{};
  Real volume = 0;  ///< at rest [m^3]; in two dimensions area [m^2]
};

/// Particle inside the tube of its nozzle.
struct NozzleParticle {
  Index particle = 0;
  std::uint64_t free_from = 0;  ///< first nominal step in which forces act on the particle
};

/// Particles of a body in world coordinates at time 0. The lists of particle data have equal
/// lengths.
struct SampledBody {
  std::vector<Vec3> positions;
  std::vector<Vec3> velocities;
  std::vector<Real> masses;
  std::vector<Real> radii;
  std::vector<Index> fixed;
  std::vector<SampledSpring> springs;
  std::vector<SampledCell> cells;            ///< only if the material has a bulk modulus
  std::vector<NozzleParticle> in_nozzles{};  ///< particles not yet moved by forces
  /// Permanent numbers of the particles. If the list is empty, no particle has been removed, and
  /// the numbers are 0, 1, 2, ...
  std::vector<Index> numbers{};
  Index next_number = 0;  ///< next number to assign; 0 if none was added or removed
};

/// Converts the description of a valid body into particles and springs. Their order depends only on
/// the description. Shapes are filled with a simple cubic lattice of `spacing`, centred on the
/// bounding box. A particle belongs to the shape if its centre is inside. The mass of a solid body
/// is given, or density * exact volume of the shape, and is distributed equally. A liquid particle
/// has the mass density * spacing^3, so that the lattice has the rest density. Rest lengths of
/// springs include the jitter, but not the displacement field, which stretches the springs. In two
/// dimensions, a square lattice fills the section at y = 0, areas replace volumes, and masses are
/// per metre [kg/m].
SampledBody sample_body(const BodyDescription& body, const Material& material, int dimensions = 3);

/// Returns the maximum number of lattice springs that begin at one lattice point.
std::size_t springs_per_point(const LatticeSprings& springs);

/// Returns all bodies of a valid scene.
std::vector<SampledBody> sample_bodies(const Scene& scene);

/// Returns pointers to the elements of `bodies`.
std::vector<const SampledBody*> pointers_to(const std::vector<SampledBody>& bodies);

/// Returns the exact volume of a sampled shape [m^3]. The result is zero for explicit particles.
Real shape_volume(const Shape& shape);

/// Returns the exact area of the section at y = 0 [m^2] of a box or a sphere, which are the shapes
/// of two-dimensional scenes. The result is zero for other shapes.
Real shape_area(const Shape& shape);

}  // namespace vat
