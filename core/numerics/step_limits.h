#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/numerics/stable_step.h"
#include "core/sampling/sampling.h"
#include "core/scene/scene.h"

namespace vat {

/// Step length above which a part of a scene is expected to become unstable.
struct StepLimit {
  std::string path;    ///< JSON pointer to the cause of the limit
  std::string reason;  ///< "... become unstable"
  Real step = 0;       ///< [s]; 0: no step is stable with this integrator
};

/// Suffix of a body's path for the part that results from melting.
inline constexpr const char* kMeltingPath = "/melting";

/// Part of a scene that oscillates or decays, with an upper bound of omega and rate.
struct OscillatingPart {
  std::string path;    ///< JSON pointer to the cause of the oscillation
  std::string reason;  ///< "... become unstable", if steps are too long
  std::string gains;   ///< "... gain energy", if the integrator has no stable step
  Oscillation bound;
  std::optional<std::size_t> body{};  ///< body whose springs or liquid are the part, if any
  /// Whether the integrator solves for damping, so that damping does not limit steps.
  bool damping_is_solved = false;
  bool is_of_liquid_on_solid = false;  ///< by the forces of liquids on the solid `body`

  /// Returns the terms of the bound that limit steps.
  Oscillation limiting() const { return {bound.omega2, damping_is_solved ? 0 : bound.rate}; }
};

/// Returns whether the static springs of the material are implicit and do not limit steps.
bool has_implicit_springs(const Scene& scene, const Material& material);

/// Returns gravity times the extent of a body along gravity [m^2/s^2]. This product is the maximum
/// pressure of a liquid at rest divided by its density.
Real weight_of(const Scene& scene, const SampledBody& body);

/// Returns whether symplectic Euler solves for the damping of bodies, so that damping does not
/// limit steps. This is true for scenes with the solver for incompressible liquids, even without
/// liquid.
bool solves_damping(const Scene& scene);

/// Returns an upper bound of omega^2 of the cells of a body with a bulk modulus [1/s^2]. The bound
/// is max_i sum_j |H_ij| / m_i. H = K / V0 sum of slope slope^T is the sum over all cells at the
/// start.
Real bound_cells(const SampledBody& body, Real bulk_modulus, int dimensions);

/// Returns the parts of the scene that limit its steps; see find_step_limits().
std::vector<OscillatingPart> find_oscillating_parts(const Scene& scene,
                                                    std::span<const SampledBody* const> samples);

/// Returns the parts of one body that do not depend on its neighbours.
std::vector<OscillatingPart> find_parts_of_body(const Scene& scene, std::size_t body,
                                                const SampledBody& sample);

/// Returns the stable step for sound in a liquid compressed by an impact, as a fraction of the
/// uncompressed value. The gas is compressed by at most 1/8. Lattices with spacing h / 2 are then
/// stable up to 0.71 h / c in the plane and 0.78 h / c in space, of which 0.9 is used. The weakly
/// compressible liquid is compressed to twice its density; see tait_pressure().
Real compressed_step_share(int dimensions);

/// Returns an upper bound of omega^2 [1/s^2] of particles under a uniform pressure that the
/// particles cannot evade. `pressure` is the pressure divided by the density [m^2/s^2]. A lattice
/// with Wendland's kernel and h = 2 spacings has omega h <= 6.2 sqrt(p / rho), so that steps up to
/// 0.32 h sqrt(rho / p) are stable. For disordered liquid, the limit is 0.18, including a margin.
Real pressed_lattice_omega2(Real pressure, Real support_radius);

/// Returns the step limits for the integrator of the scene. Each body has limits for springs, sound
/// and viscosity. Each interface, including the default interface, and each self-contact has a
/// limit for contacts. `samples` are the bodies of the scene. Each limit is the stable step for
/// upper bounds of frequency and damping:
///
/// - springs, except implicit springs: omega^2 <= 2 max_i lambda_max(sum_j k_ij n n^T) / m_i at the
///   start, and the same bound for the damping constants;
/// - sound: c dt / h <= 0.96, and viscosity: nu dt / h^2 <= 0.126. These limits correspond to omega
///   dt = 2 and rate dt = 2 for the corrected [MCG03] forces on a cubic lattice with velocity
///   Verlet. For the weakly compressible liquid, the limits are 0.77 (in the plane 0.71) and 0.028.
///   The former permits impacts that compress the liquid to twice its density. For a solid that is
///   lighter than its liquid, the liquid's omega^2 and rate are multiplied by the ratio of
///   densities, and by 1/2 if the solid is rigid;
/// - surface tension: the shortest waves on a surface that the particles resolve;
/// - contacts: omega^2 = k (n_a / m_a + n_b / m_b), with n simultaneous contacts on the mass m. For
///   a rigid body, n is the number of particles of its flattest side. The number of particles in
///   reach of one particle is an estimate. Springs and sound within the bodies are neglected.
std::vector<StepLimit> find_step_limits(const Scene& scene,
                                        const std::vector<SampledBody>& samples);

}  // namespace vat
