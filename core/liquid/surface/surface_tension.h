#pragma once

#include "core/laws/surface_tension.h"

namespace vat {

struct StepContext;

/// Stages of the surface tension sigma of a liquid as a force at its surface (J. P. Morris, Int. J.
/// Numer. Meth. Fluids 33 (2000) 333, on which [MCG03] is based), for liquids with a free surface.
///
/// With the rest volumes V_j and the kernel W, over the liquid, its solids and the mirror images in
/// walls, s_i = sum_j V_j W_ij and g_i = sum_j V_j grad_i W_ij. Particles are at the surface if |g|
/// exceeds kSurfaceThreshold / h; at a flat surface it is about 1.5 / h. Their normals n are the
/// directions of g after one smoothing, because a drop with the unsmoothed field of [MCG03] heats
/// up. The curvature kappa = -div n is computed from these particles with the normalised kernel
/// (Morris eq. 24), and F_i = 2 sigma kappa_i |g_i| n_i V_i. The factor 2 stands for the outer half
/// of the integral of |g| across the surface, which is 1.
///
/// This is the curvature of a surface kSurfaceDepth h below that of the liquid, the mean depth of
/// surface particles and their neighbours. Furthermore, more than half of |g| is in a convex
/// liquid: in d dimensions its integral is larger by kSurfaceBulge kappa h with kSurfaceBulge = int
/// |y|^2 W dA / ((d - 1) h) over the tangent plane. To first order in h kappa, the surface has
/// kappa / (1 + (kSurfaceDepth / (d - 1) + kSurfaceBulge) h kappa), which replaces kappa.
///
/// A surface without negative pressure does not hold together. Particles at the surface therefore
/// attract each other by central forces of the energy V_i e (1 - s_i)^2 for s_i < 1, with e =
/// kCohesion sigma / h. This energy depends on the local density, as that of an equation of state,
/// and adds nothing to the sigma that determines the inner pressure of a drop.
///
/// By their images, walls have the contact angle 90 degrees. For another contact angle theta,
/// measured in the liquid, the normals of particles are interpolated to the contact normal
/// sin(theta) t - cos(theta) n_wall, with t the direction of n along the wall and the weight 1 -
/// d/h at the distance d (M. Breinlinger, P. Polfer, A. Hashibon, T. Kraft, J. Comput. Phys. 243
/// (2013) 14). The normals of images are reflected at it. The curvature of a surface with another
/// angle at the wall moves the contact line.
///
/// The forces of curvature are not pairs; their sum is zero only if the surface is resolved. If the
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
