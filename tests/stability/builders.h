#pragma once

#include <string>
#include <vector>

#include "core/scene/scene.h"
#include "tests/support/scenes.h"

/// Bodies and scenes that the stability tests are made of.
namespace vat::stability {

inline constexpr Real kSpacing =
    0.05;  // [m] of every lattice here, but where a case says otherwise
inline constexpr BodyKind kKinds[] = {BodyKind::liquid, BodyKind::deformable, BodyKind::rigid};

/// Earth's gravity, the default numerics and the materials "water", "oil" (liquids, and anything
/// else), "rubber" (deformable) and "wood" (rigid). Contacts have 1 kN/m, walls 10 kN/m.
Scene make_scene();
/// The same in a closed vat from the origin to (1, 1, 1) m.
Scene make_tank();

/// n^3 particles about `center` with a mass for 1000 kg/m^3, and springs between neighbours of a
/// deformable one.
BodyDescription make_block(std::string name, BodyKind kind, int n, const Vec3& center,
                           Real spacing = kSpacing);
/// One particle.
BodyDescription make_particle(std::string name, BodyKind kind, const Vec3& position, Real mass,
                              Real radius = kSpacing / 2);
/// Two particles on the x axis with a spring.
BodyDescription make_spring_pair(std::string name, Real distance, Real rest_length,
                                 const SpringConstants& spring, std::vector<Real> masses);
/// The material that a block of this kind has.
const char* material_of(BodyKind kind);

/// Makes the scene's step the given part of its least limit, and its tick about 20 ms; every scene
/// must have one that is not 0.
void take_stable_step(Scene& scene, Real part);
/// The least limit of the scene's step; infinite where there is none.
Real least_step_limit(const Scene& scene);

}  // namespace vat::stability
