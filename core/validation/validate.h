#pragma once

#include <span>
#include <string>
#include <vector>

#include "core/sampling/sampling.h"
#include "core/scene/scene.h"
#include "core/support/result.h"

namespace vat {

struct Warning {
  std::string code;
  std::string path;  ///< JSON pointer into the scene
  std::string message;
};

/// Returns all errors of the scene, or an empty list if the scene is valid. Checks that
///
/// - values are in their ranges (given in the messages), and references by name exist;
/// - materials have the constants that each kind of body requires;
/// - each shape contains 1 to kMaxParticles particles, and meshes are closed;
/// - the tick is an integer number of steps;
/// - a two-dimensional scene is in its plane;
/// - periods exceed the reach of forces;
/// - the limits of core/limits.h hold.
///
/// Sampling is bounded: if the bodies together exceed a limit, the remaining bodies are not
/// sampled. Pairs of particles are counted only if there is no other error.
Errors find_errors(const Scene& scene);

/// Body of the scene in its current state.
struct CurrentBody {
  std::span<const Vec3> positions;  ///< [m]
  std::span<const Real> radii;      ///< same number as positions [m]
  std::size_t springs = 0;
};

/// Current state of a valid scene: its bodies in order, and the displacement of the vat.
struct CurrentScene {
  std::vector<CurrentBody> bodies;
  Vec3 vat_offset = Vec3::Zero();  ///< [m]
};

/// Returns the errors of a body to be added. Paths start with `path`. Only this body is sampled.
Errors find_body_errors(const Scene& scene, const CurrentScene& present,
                        const BodyDescription& body, const std::string& path);
/// Returns the errors of a body to be added at time 0, with all bodies at their initial positions.
Errors find_body_errors(const Scene& scene, const BodyDescription& body, const std::string& path);

/// Returns the errors of melting body `body` of the scene into the material `into`. Paths are /body
/// and /material. Nothing is sampled.
Errors find_melting_errors(const Scene& scene, const CurrentScene& present, std::size_t body,
                           const std::string& into);

/// Returns the errors of body `body` of the scene at its new position in `present`. Paths are
/// /position. Nothing is sampled.
Errors find_moved_errors(const Scene& scene, const CurrentScene& present, std::size_t body);
/// Returns the errors of the last body at its position in `present`, after this body was restored
/// to the scene. Paths are /position. Nothing is sampled.
Errors find_returned_errors(const Scene& scene, const CurrentScene& present);

/// Returns the errors of a material that is added, or replaces the material with its name, in a
/// changed scene. `known` is defined by find_changed_errors(). Paths start with `path`.
Errors find_material_errors(const Scene& scene, const CurrentScene& present,
                            const std::vector<const SampledBody*>& known, const Material& material,
                            const std::string& path);
/// Returns the scene with `material` added, or with the material of the same name replaced.
Scene with_material(Scene scene, const Material& material);

/// Returns the errors of a displacement of the vat by a user. Paths are /offset.
Errors find_moved_vat_errors(const Scene& scene, const Vec3& offset);

/// Returns the errors of the numerics and of the tolerances of incompressible liquids, in an
/// otherwise valid scene. Paths are the names of the values. Nothing is sampled.
Errors find_numerics_errors(const Scene& scene);

/// Returns the errors of an interface that is added, or replaces the interface of the same
/// materials. Paths start with `path`. Nothing is sampled.
Errors find_interface_errors(const Scene& scene, const CurrentScene& present,
                             const InterfaceDescription& interface, const std::string& path);

/// Returns the errors of a scene that was valid and has been changed by commands and time, with
/// resolved numerics. `known` contains the particles of each body, or null if they follow from its
/// description. Initial positions and pairs are not checked, because they are out of date. Total
/// limits are not checked, because each addition checked them.
Errors find_changed_errors(const Scene& scene, const std::vector<const SampledBody*>& known);

/// Returns warnings of valid settings that are probably unintended. The scene must be valid.
/// Warnings report
///
/// - settings without effect;
/// - bodies that overlap each other or the walls at the start;
/// - an unsuitable ratio of spacing and support radius;
/// - steps too long for the motion, stiffness, damping, viscosity or speed of sound;
/// - a high estimate of computing time or memory.
std::vector<Warning> find_warnings(const Scene& scene);

}  // namespace vat
