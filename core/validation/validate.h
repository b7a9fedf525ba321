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

/// Returns all errors of the scene; empty if it is valid. Checks ranges of values (named in the
/// messages), references by name, and the material constants that each kind of body needs; that
/// shapes sample to 1 to kMaxParticles particles and meshes are closed; that the tick is a whole
/// number of steps; that a two-dimensional scene is in its plane; that periods are longer than the
/// reach of forces; and the limits of core/limits.h. The sampling is bounded: if the bodies
/// together exceed a limit, the remaining ones are not sampled. Pairs of particles are counted only
/// if there is no other error.
Errors find_errors(const Scene& scene);

/// A body of the scene in its present state.
struct CurrentBody {
  std::span<const Vec3> positions;  ///< [m]
  std::span<const Real> radii;      ///< as many as positions [m]
  std::size_t springs = 0;
};

/// The present state of a valid scene: its bodies in order, and the displacement of the vat.
struct CurrentScene {
  std::vector<CurrentBody> bodies;
  Vec3 vat_offset = Vec3::Zero();  ///< [m]
};

/// The errors of a body to be added; paths start with `path`. Samples this body only.
Errors find_body_errors(const Scene& scene, const CurrentScene& present,
                        const BodyDescription& body, const std::string& path);
/// Like the above, at time 0, with all bodies at their start.
Errors find_body_errors(const Scene& scene, const BodyDescription& body, const std::string& path);

/// The errors of melting the scene's body `body` into a material; paths are /body and /material.
/// Samples nothing.
Errors find_melting_errors(const Scene& scene, const CurrentScene& present, std::size_t body,
                           const std::string& into);

/// The errors of the scene's body `body` at its new position in `present`; paths are /position.
/// Samples nothing.
Errors find_moved_errors(const Scene& scene, const CurrentScene& present, std::size_t body);
/// The errors of the last body at its position in `present`, after its return; paths are /position.
/// Samples nothing.
Errors find_returned_errors(const Scene& scene, const CurrentScene& present);

/// The errors of a material to add, or to replace the material with its name, in a scene that has
/// changed. `known` is that of find_changed_errors(). Paths start with `path`.
Errors find_material_errors(const Scene& scene, const CurrentScene& present,
                            const std::vector<const SampledBody*>& known, const Material& material,
                            const std::string& path);
/// The scene with this material added or replaced.
Scene with_material(Scene scene, const Material& material);

/// The errors of a displacement of the vat by a user; paths are /offset.
Errors find_moved_vat_errors(const Scene& scene, const Vec3& offset);

/// The errors of the integrator and the step of a scene that is otherwise valid; paths are
/// /integrator and /step. Samples nothing.
Errors find_numerics_errors(const Scene& scene);

/// The errors of an interface to add, or to replace the interface of the same materials; paths
/// start with `path`. Samples nothing.
Errors find_interface_errors(const Scene& scene, const CurrentScene& present,
                             const InterfaceDescription& interface, const std::string& path);

/// The errors of a scene that was valid and has been changed by commands and time, with resolved
/// numerics. Initial positions and pairs are not checked, since they are out of date; the limits of
/// the total were checked with each addition. `known`: the particles of each body; null if they
/// follow from its description.
Errors find_changed_errors(const Scene& scene, const std::vector<const SampledBody*>& known);

/// Warnings of settings that are valid but probably unintended: settings without effect, bodies
/// that overlap each other or the walls at the start, an unsuitable ratio of spacing and support
/// radius, steps that are too long for the motion, stiffness, damping, viscosity or speed of sound,
/// and a high estimate of time and memory. The scene must be valid.
std::vector<Warning> find_warnings(const Scene& scene);

}  // namespace vat
