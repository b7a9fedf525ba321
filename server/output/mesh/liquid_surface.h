#pragma once

#include <span>
#include <string_view>

#include "core/simulation/body_values.h"
#include "server/output/mesh/shape_mesh.h"

namespace vat {

/// Returns the surface of liquid particles as closed meshes with edges of about one particle
/// radius. `positions` [m] and `radii` [m, positive] have one element for each particle. The
/// surface of a resting liquid is half a spacing (one radius) above its highest particles. An
/// isolated particle has a round surface. Gaps between liquids that are
/// wider than about two spacings remain.
///
/// Method: level set of Zhu and Bridson 2005 (Animating Sand as a Fluid, eq. 1) with the correction
/// of Solenthaler et al. 2007 (A Unified Particle Model for Fluid-Solid Interactions, section 5),
/// and surface nets (Gibson 1998) on a sparse grid.
SurfaceMesh liquid_surface(std::span<const Vec3> positions, std::span<const Real> radii);

/// Returns the surface of all liquids of a material, which is empty without such liquids.
SurfaceMesh liquid_surface(std::span<const BodyView> bodies, std::string_view material);

}  // namespace vat
