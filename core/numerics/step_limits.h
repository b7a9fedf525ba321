#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/numerics/stable_step.h"
#include "core/sampling/sampling.h"
#include "core/scene/scene.h"

namespace vat {

/// A step length beyond which a part of a scene is expected to become unstable.
struct StepLimit {
  std::string path;    ///< JSON pointer to the cause of the limit
  std::string reason;  ///< "... become unstable"
  Real step = 0;       ///< [s]; 0: no step is stable with this integrator
};

/// Suffix of the path of a body for the part that its melting adds.
inline constexpr const char* kMeltingPath = "/melting";

/// A part of a scene that oscillates or decays, as an upper bound.
struct OscillatingPart {
  std::string path;    ///< JSON pointer to the cause of the oscillation
  std::string reason;  ///< "... become unstable", for too long steps
  std::string gains;   ///< "... gain energy", for integrators without a stable step
  Oscillation bound;
  std::optional<std::size_t> body{};  ///< the body, if the part is its springs or liquid
  bool damping_is_solved = false;  ///< the integrator solves for damping that steps do not resolve

  /// The part of the bound that limits steps.
  Oscillation limiting() const { return {bound.omega2, damping_is_solved ? 0 : bound.rate}; }
};

/// Returns whether the static springs of the material limit no step.
bool has_implicit_springs(const Scene& scene, const Material& material);

/// Gravity times the extent of a body along it [m^2/s^2]: the maximum pressure of a liquid at rest
/// / its density.
Real weight_of(const Scene& scene, const SampledBody& body);

/// Returns whether symplectic Euler solves for the damping of bodies, so that damping limits no
/// step. This holds for scenes with the solver for incompressible liquids, even without liquid.
bool solves_damping(const Scene& scene);

/// An upper bound of omega^2 of the cells of a body with a bulk modulus [1/s^2]: max_i sum_j |H_ij|
/// / m_i with H = K / V0 sum of slope slope^T over all cells at the start.
Real bound_cells(const SampledBody& body, Real bulk_modulus, int dimensions);

/// The parts of the scene that limit its steps; see find_step_limits().
std::vector<OscillatingPart> find_oscillating_parts(const Scene& scene,
                                                    std::span<const SampledBody* const> samples);

/// The parts of one body without its neighbours.
std::vector<OscillatingPart> find_parts_of_body(const Scene& scene, std::size_t body,
                                                const SampledBody& sample);

/// The factor of the stable step for sound in a liquid that an impact compresses. The gas is
/// compressed by up to an eighth: lattices of h / 2 are then stable up to 0.71 h / c in the plane
/// and 0.78 h / c in space, and nine tenths of this are used. The weakly compressible liquid is
/// compressed to twice its density; see tait_pressure().
Real compressed_step_share(int dimensions);

/// A bound of omega^2 of particles under a uniform pressure that they cannot evade. `pressure` is
/// divided by the density [m^2/s^2]. A lattice of Wendland's kernel with h = 2 spacings has omega h
/// = 6.2 sqrt(p / rho) at most, so that steps up to 0.32 h sqrt(rho / p) are stable. For liquid
/// that has flowed, the limit is 0.18, with a margin.
Real pressed_lattice_omega2(Real pressure, Real support_radius);

/// The step limits of the scene's springs, sound and viscosity (by body) and contacts (by
/// interface, the default one included, and by self-contact), for its integrator. `samples` are the
/// scene's bodies. Each limit is the stable step for upper bounds of frequency and damping:
///
/// - springs, except implicit ones: omega^2 <= 2 max_i lambda_max(sum_j k_ij n n^T) / m_i at the
///   start, and the same for the damping constants;
/// - sound, c dt / h <= 0.96, and viscosity, nu dt / h^2 <= 0.126: the limits of the corrected
///   [MCG03] forces on a cubic lattice with velocity Verlet, as omega dt = 2 and rate dt = 2. For
///   the weakly compressible liquid 0.77 (in the plane 0.71), which allows for impacts that
///   compress it to twice its density, and 0.028. A solid that is lighter than its liquid has the
///   liquid's omega^2 and rate times the ratio of densities, and half of this if it is rigid;
/// - surface tension: the shortest waves of a surface of the particles;
/// - contacts: omega^2 = k (n_a / m_a + n_b / m_b), with n simultaneous contacts on the mass m; for
///   a rigid body n is the number of particles of its flattest side. The number of particles in
///   reach of one particle is an estimate. Springs and sound within the bodies are neglected.
std::vector<StepLimit> find_step_limits(const Scene& scene,
                                        const std::vector<SampledBody>& samples);

}  // namespace vat
