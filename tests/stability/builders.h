#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/scene/scene.h"
#include "tests/support/scenes.h"

/// Bodies and scenes of the stability tests.
namespace vat::stability {

inline constexpr Real kSpacing = 0.05;  // [m] lattice spacing, unless a case has another
inline constexpr BodyKind kKinds[] = {BodyKind::liquid, BodyKind::deformable, BodyKind::rigid};

/// Returns a scene with Earth's gravity, default numerics and the materials "water" and "oil" (for
/// all kinds), "rubber" (deformable) and "wood" (rigid). Contacts have 1 kN/m, walls 10 kN/m.
Scene make_scene();
/// Returns the same scene in a closed vat from the origin to (1, 1, 1) m.
Scene make_tank();

/// Returns n^3 particles around `center` with 1000 kg/m^3. If the block is deformable, springs join
/// neighbours.
BodyDescription make_block(std::string name, BodyKind kind, int n, const Vec3& center,
                           Real spacing = kSpacing);
/// Returns a body of one particle.
BodyDescription make_particle(std::string name, BodyKind kind, const Vec3& position, Real mass,
                              Real radius = kSpacing / 2);
/// Returns a body of two particles on the x axis that a spring joins.
BodyDescription make_spring_pair(std::string name, Real distance, Real rest_length,
                                 const SpringConstants& spring, std::vector<Real> masses);
/// Returns the material of blocks of this kind.
const char* material_of(BodyKind kind);

/// Sets the step to the fraction `part` of its smallest limit, and the tick to about 20 ms. The
/// limit must be finite and positive.
void take_stable_step(Scene& scene, Real part);
/// Returns the scene with local steps, in which each solid takes at least eight sub-steps in each
/// step of the scene; nothing if the scene has no solid or local steps do not support it.
std::optional<Scene> with_sub_steps(Scene scene);
/// Returns the smallest limit of the scene's step; infinite if there is none.
Real least_step_limit(const Scene& scene);

}  // namespace vat::stability
