#pragma once

#include "core/laws/surface_tension.h"

namespace vat {

struct StepContext;

/// Stages of the surface tension sigma of a liquid as a force at its surface (J. P. Morris, Int. J.
/// Numer. Meth. Fluids 33 (2000) 333, on which [MCG03] is based), for liquids with a free surface.
///
/// Let s_i = sum_j V_j W_ij and g_i = sum_j V_j grad_i W_ij, with rest volumes V_j and kernel W.
/// The sums are over the liquid, its solids and mirror images in walls. Particles are at the
/// surface if |g| exceeds kSurfaceThreshold / h; at a flat surface it is about 1.5 / h. Their
/// normals n are the directions of g after one smoothing. With the unsmoothed field of [MCG03], the
/// kinetic energy of a drop grows. The curvature kappa = -div n is computed from these particles
/// with the normalised kernel (Morris eq. 24), and F_i = 2 sigma kappa_i |g_i| n_i V_i. The
/// integral of |g| across the surface is 1, and the factor 2 compensates its missing outer half.
///
/// This is the curvature of a surface at the depth kSurfaceDepth h, the mean depth of surface
/// particles and their neighbours. If the liquid is convex, more than half of |g| is inside. In d
/// dimensions, this part is larger by kSurfaceBulge kappa h. kSurfaceBulge is int |y|^2 W dA / ((d
/// - 1) h) over the tangent plane. To first order in h kappa, the surface has kappa / (1 +
/// (kSurfaceDepth / (d - 1) + kSurfaceBulge) h kappa), which replaces kappa.
///
/// A surface without negative pressure does not hold together. Particles at the surface therefore
/// attract each other by central forces of the energy V_i e (1 - s_i)^2 for s_i < 1, with e =
/// kCohesion sigma / h. Like the energy of an equation of state, this energy depends on the local
/// density. It does not change the sigma that determines the inner pressure of a drop.
///
/// By their images, walls have the contact angle 90 degrees. For another contact angle theta,
/// measured in the liquid, the normals of particles are interpolated to the contact normal
/// sin(theta) t - cos(theta) n_wall, with t the direction of n along the wall and the weight 1 -
/// d/h at the distance d (M. Breinlinger, P. Polfer, A. Hashibon, T. Kraft, J. Comput. Phys. 243
/// (2013) 14). The normals of images are reflected at the contact normal. The curvature of a
/// surface with another angle at the wall moves the contact line.
///
/// The curvature forces are not pairwise; their sum is zero only if the surface is resolved. If the
/// liquid touches neither walls nor solids, the remainder is subtracted over the whole surface.
/// This conserves momentum and, except in a periodic world, angular momentum. Solids feel these
/// forces only by the pressure of the liquid.

/// Computes g_i and 1 - s_i.
void find_surface(StepContext& context);

/// Computes n_i; zero away from the surface.
void find_surface_normals(StepContext& context);

/// Adds the forces on liquid particles.
void add_surface_tension(StepContext& context);

}  // namespace vat
