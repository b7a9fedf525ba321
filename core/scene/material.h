#pragma once

#include <optional>
#include <string>

#include "core/scene/appearance.h"
#include "core/types.h"

/// Material constants. core/scene/material_members.h lists their ranges and units.
namespace vat {

/// Constants of a Hooke spring: the stiffness k [N/m] of (Boldt eq. 3), and the damping along the
/// spring [N s/m]. The paper has no damping, which corresponds to 0.
struct SpringConstants {
  Real stiffness = 0;
  Real damping = 0;
  bool operator==(const SpringConstants&) const = default;
};

/// SPH constants of a liquid material.
struct LiquidConstants {
  Real stiffness = 0;       ///< k of (Boldt eq. 14), the square of the speed of sound [m^2/s^2]
  Real viscosity = 0;       ///< dynamic viscosity mu [Pa s]
  Real support_radius = 0;  ///< h [m]; every kernel is zero at this distance
  /// Artificial viscosity alpha, which damps the sound of impacts. It adds alpha rho c h / (4 (d +
  /// 2)) to the viscosity of weakly compressible liquids in d dimensions.
  Real artificial_viscosity = 0.02;
  Real surface_tension = 0;  ///< sigma [N/m]; see core/liquid/surface/surface_tension.h
  bool operator==(const LiquidConstants&) const = default;
};

/// Static springs between lattice neighbours of a sampled deformable body. Structural springs are
/// along the axes, and shear springs along face diagonals. Bend springs join second neighbours
/// along the axes. A kind without constants has no springs.
struct LatticeSprings {
  std::optional<SpringConstants> structural;
  std::optional<SpringConstants> shear;
  std::optional<SpringConstants> bend;
  bool operator==(const LatticeSprings&) const = default;
};

/// Plastic flow of static springs. The model is rate-independent with linear kinematic hardening
/// (J. C. Simo, T. J. R. Hughes, Computational Inelasticity, Springer, 1998, section 1.2). With a
/// relaxation time, it is rate-dependent (section 1.7). e is the strain of the current length, and
/// p is the strain of the current rest length, both relative to the initial rest length l0. A
/// spring is elastic if |e - p - hardening p| <= yield_strain.
struct Plasticity {
  Real yield_strain = 0;
  Real hardening = 0;        ///< plastic modulus / stiffness; 0: perfectly plastic
  Real relaxation_time = 0;  ///< relaxation of the stress beyond yield [s]; 0: instantaneous
  Real max_strain = 0.5;     ///< maximum |p|
  bool operator==(const Plasticity&) const = default;
};

/// Material. The kind of a body determines the parts of its material that are used.
struct Material {
  std::string name;
  Real density = 1000;                          ///< [kg/m^3]; rest density of a liquid
  std::optional<LiquidConstants> liquid;        ///< required for liquid bodies
  std::optional<LatticeSprings> springs;        ///< for sampled deformable bodies
  std::optional<SpringConstants> self_contact;  ///< dynamic springs within one deformable body
  /// Whether static springs are solved implicitly, so that springs do not limit the step; see
  /// core/solid/implicit_springs.h. Requires velocity Verlet, with fixed or adaptive steps.
  bool implicit_springs = false;
  std::optional<Plasticity> plasticity{};  ///< of static springs; if absent, springs are elastic
  std::optional<Real> tearing_strain{};    ///< static springs tear permanently at this strain e
  /// Maximum strain of static springs; see core/solid/elongation_limit.h. Requires symplectic Euler
  /// or velocity Verlet, with fixed or adaptive steps, without implicit springs.
  std::optional<Real> elongation_limit{};
  /// Bulk modulus K [Pa], in two dimensions [N/m]. Lattice cells of sampled deformable bodies
  /// resist changes of volume; see core/solid/volume.h.
  Real bulk_modulus = 0;
  Appearance appearance{};  ///< without effect on the physics
  bool operator==(const Material&) const = default;
};

}  // namespace vat
