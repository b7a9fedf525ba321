#pragma once

#include "core/liquid/surface/scratch.h"

namespace vat {

struct StepContext;

/// Stages of surface tension by curvature, for liquids with a free surface. The surface tension
/// sigma is a force at the surface (J. P. Morris, Int. J. Numer. Meth. Fluids 33 (2000) 333, the
/// basis of [MCG03]).
///
/// Let s_i = sum_j V_j W_ij and g_i = sum_j V_j grad_i W_ij, with the rest volumes V_j and the
/// kernel W. The sums are over liquid, solids and images in walls. A particle is at the surface if
/// |g| exceeds kSurfaceThreshold / h; at a flat surface, |g| is about 1.5 / h. The normal n of a
/// surface particle is the direction of g after one smoothing. With the unsmoothed field of
/// [MCG03], the kinetic energy of a drop increases. The curvature kappa = -div n is a sum over
/// surface particles with the normalised kernel (Morris eq. 24). The force is F_i = 2 sigma kappa_i
/// |g_i| n_i V_i. The integral of |g| across the surface is 1, and the factor 2 compensates for its
/// missing outer half.
///
/// The sum yields the curvature of a surface at the depth kSurfaceDepth h, which is the mean depth
/// of surface particles and their neighbours. If the liquid is convex, the part of |g| inside the
/// liquid is more than half. In d dimensions, the inner part is larger by kSurfaceBulge kappa h,
/// with kSurfaceBulge = int |y|^2 W dA / ((d - 1) h) over the tangent plane. To first order in h
/// kappa, both effects are corrected if kappa is replaced by kappa / (1 + (kSurfaceDepth / (d - 1)
/// + kSurfaceBulge) h kappa).
///
/// Without negative pressure, a surface has no cohesion. Particles at the surface therefore attract
/// each other by central forces with the energy V_i e (1 - s_i)^2 for s_i < 1, with e = kCohesion
/// sigma / h. Like the energy of an equation of state, this energy depends on the local density.
/// The attraction does not change the surface tension that determines the inner pressure of a drop.
///
/// The images in walls cause a contact angle of 90 degrees. For another contact angle theta,
/// measured in the liquid, the normals of particles near a wall are interpolated to the contact
/// normal sin(theta) t - cos(theta) n_wall (M. Breinlinger, P. Polfer, A. Hashibon, T. Kraft, J.
/// Comput. Phys. 243 (2013) 14). t is the direction of n along the wall, and the weight of the
/// contact normal at the distance d from the wall is 1 - d/h. The normals of images are reflected
/// at the contact normal. If the angle of the surface at the wall differs from theta, the resulting
/// curvature moves the contact line.
///
/// The curvature forces are not pairwise, so that their sum is zero only for a well-resolved
/// surface. If the liquid touches neither walls nor solids, the sum is subtracted, distributed over
/// the whole surface. The subtraction conserves momentum and, except in a periodic world, angular
/// momentum. The curvature forces affect solids only through the pressure of the liquid.

/// A rigid motion of the surface. A particle with the weight sigma times area at x gets the force
/// -weight (excess + turn x (x - center)).
struct SurfaceBalance {
  Vec3 excess = Vec3::Zero();
  Vec3 turn = Vec3::Zero();
  Vec3 center = Vec3::Zero();
};

/// Returns the motion whose forces make the sum of curvature forces zero and, if `balances_torque`
/// is set, that of their torques.
SurfaceBalance balance_of(const SurfaceSum& sum, bool balances_torque);

/// Stage that computes g_i and max(0, 1 - s_i).
void find_surface(StepContext& context);

/// Stage that computes n_i, which is zero away from the surface.
void find_surface_normals(StepContext& context);

/// Stage that adds the forces on liquid particles.
void add_surface_tension(StepContext& context);

}  // namespace vat
