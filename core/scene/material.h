#pragma once

#include <optional>
#include <string>

#include "core/types.h"

/// Material constants. core/scene/material_members.h lists their ranges and units.
namespace vat {

/// Constants of a Hooke spring: stiffness k [N/m] of Boldt eq. 3 and damping along the spring
/// [N s/m] (not in the paper; 0 is the paper's spring).
struct SpringConstants {
  Real stiffness = 0;
  Real damping = 0;
};

/// SPH constants of a liquid material.
struct LiquidConstants {
  Real stiffness = 0;       ///< k of Boldt eq. 14 [m^2/s^2], the square of the speed of sound
  Real viscosity = 0;       ///< dynamic viscosity mu [Pa s]
  Real support_radius = 0;  ///< h [m]: every kernel is zero at this distance
  /// alpha: adds alpha rho c h / (4 (d + 2)) to the viscosity of weakly compressible liquids, in d
  /// dimensions; it damps the sound of impacts.
  Real artificial_viscosity = 0.02;
  Real surface_tension = 0;  ///< sigma [N/m]; see core/liquid/surface/surface_tension.h
};

/// Static springs between lattice neighbours of a sampled deformable body: structural along the
/// axes, shear along face diagonals, bend between second neighbours along the axes. An absent kind
/// makes no springs.
struct LatticeSprings {
  std::optional<SpringConstants> structural;
  std::optional<SpringConstants> shear;
  std::optional<SpringConstants> bend;
};

/// Plastic flow of static springs (rate-independent: J. C. Simo, T. J. R. Hughes, Computational
/// Inelasticity, Springer, 1998, section 1.2 with linear kinematic hardening; with a relaxation
/// time: section 1.7). With l0 the rest length at the start, e is the strain of the present length
/// and p that of the present rest length. A spring is elastic if |e - p - hardening p| <=
/// yield_strain.
struct Plasticity {
  Real yield_strain = 0;
  Real hardening = 0;        ///< plastic modulus / stiffness; 0: perfectly plastic
  Real relaxation_time = 0;  ///< of the stress beyond yield [s]; 0: there is no such stress
  Real max_strain = 0.5;     ///< maximum |p|
};

/// A material. A body uses the parts that its kind needs.
struct Material {
  std::string name;
  Real density = 1000;                          ///< [kg/m^3]; rest density of a liquid
  std::optional<LiquidConstants> liquid;        ///< required for liquid bodies
  std::optional<LatticeSprings> springs;        ///< used by sampled deformable bodies
  std::optional<SpringConstants> self_contact;  ///< dynamic springs within one deformable body
  /// Static springs are solved implicitly, so that they limit no step; see
  /// core/solid/implicit_springs.h. Needs velocity Verlet, with fixed or adaptive steps.
  bool implicit_springs = false;
  std::optional<Plasticity> plasticity{};  ///< of static springs; without, they are elastic
  std::optional<Real> tearing_strain{};    ///< static springs tear at this strain e, permanently
  /// Maximum strain of static springs; see core/solid/elongation_limit.h. Needs symplectic Euler or
  /// velocity Verlet, with fixed or adaptive steps, without implicit springs.
  std::optional<Real> elongation_limit{};
  /// K [Pa], in two dimensions [N/m]: lattice cells of sampled deformable bodies resist changes of
  /// their volume, see core/solid/volume.h.
  Real bulk_modulus = 0;
};

}  // namespace vat
