#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/numerics/stable_step.h"
#include "core/sampling/sampling.h"
#include "core/scene/scene.h"

namespace vat {

/// A step length above which part of a scene is expected to become unstable.
struct StepLimit {
  std::string path;    ///< JSON pointer to what limits the step
  std::string reason;  ///< "... become unstable"
  Real step = 0;       ///< [s]; 0: no step is stable with this integrator
};

/// What follows the path of a body whose melting makes a part that oscillates.
inline constexpr const char* kMeltingPath = "/melting";

/// A part of a scene that oscillates or decays, as an upper bound.
struct OscillatingPart {
  std::string path;    ///< JSON pointer to what makes it oscillate
  std::string reason;  ///< "... become unstable", where a step is too long
  std::string gains;   ///< "... gain energy", with an integrator for which no step is short enough
  Oscillation bound;
  std::optional<std::size_t> body{};  ///< where it is one body's springs or liquid
  bool damping_is_solved = false;     ///< by the integrator, where steps do not resolve it

  /// What is left of the bound for the length of steps.
  Oscillation limiting() const { return {bound.omega2, damping_is_solved ? 0 : bound.rate}; }
};

/// Whether static springs of the material limit no step.
bool has_implicit_springs(const Scene& scene, const Material& material);

/// The scene's gravity times how deep a body is along it [m^2/s^2]: the greatest pressure of a
/// liquid at rest over its density.
Real weight_of(const Scene& scene, const SampledBody& body);

/// Whether symplectic Euler solves for what damps bodies, so that it limits no step: in scenes of
/// incompressible liquids, while there is liquid and when there is none.
bool solves_damping(const Scene& scene);

/// A bound of omega^2 of the cells of a body that keep their volume [1/s^2]: max_i sum_j |H_ij| /
/// m_i of H = K / V0 sum of slope slope^T over all cells as they start.
Real bound_cells(const SampledBody& body, Real bulk_modulus, int dimensions);

/// The parts of the scene that limit its steps; see find_step_limits().
std::vector<OscillatingPart> find_oscillating_parts(const Scene& scene,
                                                    std::span<const SampledBody* const> samples);

/// Those that one body makes by itself.
std::vector<OscillatingPart> find_parts_of_body(const Scene& scene, std::size_t body,
                                                const SampledBody& sample);

/// What is left of the step that is stable for sound where an impact compresses the liquid. Of the
/// gas by up to an eighth: lattices of h / 2 are then stable up to 0.71 h / c in the plane and 0.78
/// h / c in space, nine tenths of which are the step that is taken. Of the weakly compressible
/// liquid to twice its density, see tait_pressure().
Real compressed_step_share(int dimensions);

/// Bounds omega^2 of particles that a pressure keeps in their places, where it gives way to
/// nothing: `pressure` is over the density [m^2/s^2]. Under one pressure everywhere a lattice of
/// Wendland's kernel has omega h = 6.2 sqrt(p / rho) at most, with h = 2 spacings, so that steps up
/// to 0.32 h sqrt(rho / p) are stable; of liquid that has flowed 0.18, with some reserve.
Real pressed_lattice_omega2(Real pressure, Real support_radius);

/// The limits of the scene's springs, sound and viscosity (by body) and of its contacts (by
/// interface, the default one included, and by self-contact), for its integrator. `samples` are the
/// scene's bodies. Each is the step that is stable for upper bounds of frequency and damping:
///
/// - springs, but for implicit ones: omega^2 <= 2 max_i lambda_max(sum_j k_ij n n^T) / m_i at the
/// start, and the same of
///   the damping constants;
/// - sound: c dt / h <= 0.96 and viscosity: nu dt / h^2 <= 0.126, the limits of the corrected
///   [MCG03] forces on a cubic lattice under velocity Verlet, as omega dt = 2 and rate dt = 2;
///   Of the weakly compressible liquid 0.77 (in the plane 0.71), which allows for impacts that
///   compress it to twice its density, and 0.028, and a solid lighter than the liquid that it
///   is in has the liquid's omega^2 and rate times the ratio of densities, half of that if rigid;
/// - surface tension: the shortest waves that a surface of the particles shows;
/// - contacts: omega^2 = k (n_a / m_a + n_b / m_b) where n contacts act at once on the mass m: on a
///   rigid body as many as its flattest side has particles. How many particles of a lattice one
///   particle reaches is an estimate, and the springs or sound within the bodies are left out.
std::vector<StepLimit> find_step_limits(const Scene& scene,
                                        const std::vector<SampledBody>& samples);

}  // namespace vat
