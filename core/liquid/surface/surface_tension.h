#pragma once

#include "core/laws/surface_tension.h"

namespace vat {

struct StepContext;

/// Stages of a liquid's surface tension sigma: a force at the surface (J. P. Morris, Int. J. Numer.
/// Meth. Fluids 33 (2000) 333, which [MCG03] takes it from), for liquids with nothing around them.
///
/// With V_j the rest volumes and W the kernel, over the liquid, the solids in it and the walls'
/// mirror images, s_i = sum_j V_j W_ij and g_i = sum_j V_j grad_i W_ij. Particles with |g| above
/// kSurfaceThreshold / h, of about 1.5 / h at a flat surface, are at the surface. Their normals n
/// are the directions of g after one smoothing, for with [MCG03]'s unsmoothed field a drop heats
/// itself up. The curvature kappa = -div n is taken among them with the kernel normalised (Morris
/// eq. 24), and F_i = 2 sigma kappa_i |g_i| n_i V_i: outside of a liquid is half of the integral of
/// |g| across its surface, which is 1.
///
/// That curvature is of a surface kSurfaceDepth h below the liquid's own, where the particles and
/// their neighbours at the surface are in the mean, and more than half of |g| is in a liquid that
/// bulges: in d dimensions the integral is larger by kSurfaceBulge kappa h with kSurfaceBulge =
/// int |y|^2 W dA / ((d - 1) h) over the tangent plane. To the first order in h kappa the surface
/// has kappa / (1 + (kSurfaceDepth / (d - 1) + kSurfaceBulge) h kappa), which stands for kappa.
///
/// A surface whose pressure is never negative is not held together, so particles there attract each
/// other as if by the energy V_i e (1 - s_i)^2 where s_i < 1, e = kCohesion sigma / h, along the
/// line between them: a pair of equal and opposite forces.
///
/// The energy is of the local density, as an equation of state's is, and adds nothing to sigma that
/// a drop's inner pressure shows.
///
/// By their images, walls let the surface meet them at 90 degrees. At another contact angle theta,
/// measured in the liquid, the normals of particles go over into the normal of contact, sin(theta)
/// t - cos(theta) n_wall with t the direction of n along the wall, in the share 1 - d/h at the
/// distance d (M. Breinlinger, P. Polfer, A. Hashibon, T. Kraft, J. Comput. Phys. 243 (2013) 14),
/// and those of images are turned round from there. What a surface that meets the wall at another
/// angle bends by moves its line.
///
/// The forces of curvature are no pairs, and add up to nothing only as far as the surface is
/// resolved. Where liquid meets neither walls nor solids, what is left over is taken back from all
/// of the surface, which keeps momentum and, but in a periodic world, angular momentum.
/// Solids feel these forces by the liquid's pressure alone.

/// g_i, and what s_i lacks of 1.
void find_surface(StepContext& context);

/// n_i; zero away from the surface.
void find_surface_normals(StepContext& context);

/// The forces on liquid particles.
void add_surface_tension(StepContext& context);

}  // namespace vat
