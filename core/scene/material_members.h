#pragma once

#include <array>
#include <optional>
#include <variant>

#include "core/limits.h"
#include "core/scene/material.h"

/// Tables of the numbers and switches of materials. The tables are used by validation, by the
/// reader and the writer of scene files, and by the tests of protocol/SCENE.md and of the schema.
namespace vat {

/// Member of a part of a material: a number with its inclusive range, or a switch. The default
/// value is that of the struct.
template <class Part>
struct Member {
  const char* name;  ///< name in scene files
  std::variant<Real Part::*, std::optional<Real> Part::*, bool Part::*> value;
  bool is_required = false;
  Real min = 0;
  Real max = 0;
  const char* unit = "";     ///< as in SCENE.md; empty: dimensionless
  const char* meaning = "";  ///< as in SCENE.md
  const char* note = "";     ///< text after the range in SCENE.md

  /// Returns the number in `part`. The result is empty for a switch and for an absent number.
  std::optional<Real> number_in(const Part& part) const {
    if (const auto* real = std::get_if<Real Part::*>(&value)) return part.**real;
    if (const auto* optional = std::get_if<std::optional<Real> Part::*>(&value)) {
      return part.**optional;
    }
    return {};
  }
};

template <class Part>
inline constexpr std::array<Member<Part>, 0> kMembersOf{};

template <>
inline constexpr std::array kMembersOf<SpringConstants>{
    Member<SpringConstants>{"stiffness", &SpringConstants::stiffness, true, 0, kMaxStiffness, "N/m",
                            "stiffness"},
    Member<SpringConstants>{"damping", &SpringConstants::damping, false, 0, kMaxDamping, "N s/m",
                            "damping along the spring"},
};

template <>
inline constexpr std::array kMembersOf<LiquidConstants>{
    Member<LiquidConstants>{"stiffness", &LiquidConstants::stiffness, true, 0, kMaxStiffness,
                            "m²/s²", "square of the speed of sound"},
    Member<LiquidConstants>{"viscosity", &LiquidConstants::viscosity, true, 0, kMaxViscosity,
                            "Pa s", "dynamic viscosity"},
    Member<LiquidConstants>{"support_radius", &LiquidConstants::support_radius, true, kMinLength,
                            kMaxLength, "m", "radius of the smoothing kernels",
                            "at most 8 spacings; 2 spacings are suitable for most scenes"},
    Member<LiquidConstants>{"artificial_viscosity", &LiquidConstants::artificial_viscosity, false,
                            0, kMaxArtificialViscosity, "", "α of `\"tait\"`",
                            "damps the sound of impacts"},
    Member<LiquidConstants>{"surface_tension", &LiquidConstants::surface_tension, false, 0,
                            kMaxSurfaceTension, "N/m", "σ",
                            "see [surface tension](#surface-tension)"},
};

template <>
inline constexpr std::array kMembersOf<Plasticity>{
    Member<Plasticity>{"yield_strain", &Plasticity::yield_strain, true, 0, kMaxStrain, "",
                       "strain at which plastic flow begins"},
    Member<Plasticity>{"hardening", &Plasticity::hardening, false, 0, kMaxHardening, "",
                       "hardening modulus / stiffness of the spring"},
    Member<Plasticity>{"relaxation_time", &Plasticity::relaxation_time, false, 0, kMaxPeriod, "s",
                       "time in which the stress beyond yield falls to 1/e"},
    Member<Plasticity>{"max_strain", &Plasticity::max_strain, false, 0, kMaxPlasticStrain, "",
                       "maximum plastic strain"},
};

template <>
inline constexpr std::array kMembersOf<Material>{
    Member<Material>{"density", &Material::density, false, kMinDensity, kMaxDensity, "kg/m³",
                     "density; rest density of a liquid"},
    Member<Material>{"implicit_springs", &Material::implicit_springs, false, 0, 0, "",
                     "`true`: an implicit solve for the springs of deformable bodies"},
    Member<Material>{"tearing_strain", &Material::tearing_strain, false, kMinStrain, kMaxStrain, "",
                     "strain at which springs tear"},
    Member<Material>{"elongation_limit", &Material::elongation_limit, false, 0, kMaxStrain, "",
                     "maximum strain of springs"},
    Member<Material>{"bulk_modulus", &Material::bulk_modulus, false, 0, kMaxStiffness, "Pa",
                     "K, resistance of deformable bodies to changes of volume",
                     "[N/m] in two dimensions"},
};

template <>
inline constexpr std::array kMembersOf<Appearance>{
    Member<Appearance>{"roughness", &Appearance::roughness, false, 0, 1, "", "0: mirror, 1: matt"},
    Member<Appearance>{"metalness", &Appearance::metalness, false, 0, 1, "",
                       "0: dielectric, 1: metal"},
    Member<Appearance>{"opacity", &Appearance::opacity, false, 0, 1, "",
                       "0: transparent, 1: opaque"},
    Member<Appearance>{"absorption_length", &Appearance::absorption_length, false, kMinLength,
                       kMaxLength, "m", "depth at which white light has the colour"},
};

}  // namespace vat
