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

/// Every error of the scene at once; empty where it is valid. Checks each value's range (named in
/// the message), references by name, that each body's material has what its kind needs, that shapes
/// sample to at least one and at most kMaxParticles particles, mesh closedness, that the tick is a
/// whole number of steps, that a scene of two dimensions stays in its plane and periods are longer
/// than forces reach, and the limits of core/limits.h. What must be sampled to be checked is
/// bounded: once the bodies exceed a limit together, the rest are not sampled. Pairs of particles
/// are counted where nothing else is wrong.
Errors find_errors(const Scene& scene);

/// One of the scene's bodies as it is now.
struct CurrentBody {
  std::span<const Vec3> positions;  ///< [m]
  std::span<const Real> radii;      ///< [m] as many
  std::size_t springs = 0;
};

/// What became of a scene without errors: its bodies in their order, and how far the vat has moved.
struct CurrentScene {
  std::vector<CurrentBody> bodies;
  Vec3 vat_offset = Vec3::Zero();  ///< [m]
};

/// The errors of one body to be added; paths start with `path`. Only the body itself is sampled.
Errors find_body_errors(const Scene& scene, const CurrentScene& present,
                        const BodyDescription& body, const std::string& path);
/// The same at time 0, with every body of the scene where it starts.
Errors find_body_errors(const Scene& scene, const BodyDescription& body, const std::string& path);

/// The errors of melting the scene's body `body` into a material; paths are /body and /material.
/// Samples nothing.
Errors find_melting_errors(const Scene& scene, const CurrentScene& present, std::size_t body,
                           const std::string& into);

/// The errors of the scene's body `body` where it is put: `present` has it there. Paths are
/// /position. Samples nothing.
Errors find_moved_errors(const Scene& scene, const CurrentScene& present, std::size_t body);
/// The same of the last body, which comes to where `present` has it.
Errors find_returned_errors(const Scene& scene, const CurrentScene& present);

/// The errors of a material that is added or that replaces the one of its name, of a scene that has
/// changed; `known` is as for find_changed_errors(). Paths start with `path`.
Errors find_material_errors(const Scene& scene, const CurrentScene& present,
                            const std::vector<const SampledBody*>& known, const Material& material,
                            const std::string& path);
/// The scene with it.
Scene with_material(Scene scene, const Material& material);

/// The errors of a vat that a hand moves so far from where it is by itself; paths are /offset.
Errors find_moved_vat_errors(const Scene& scene, const Vec3& offset);

/// The errors of the integrator and the step of a scene that has none but by these; paths are
/// /integrator and /step. Samples nothing.
Errors find_numerics_errors(const Scene& scene);

/// The errors of an interface that is added or that replaces the one of the same materials; paths
/// start with `path`. Samples nothing.
Errors find_interface_errors(const Scene& scene, const CurrentScene& present,
                             const InterfaceDescription& interface, const std::string& path);

/// The errors of a scene that commands and time have changed since it was found to have none, its
/// numerics chosen: where bodies began and how many pairs they made then says nothing of it any
/// more, and what they are together was limited as they came. `known`, by body: its particles; null
/// where they are those of its description.
Errors find_changed_errors(const Scene& scene, const std::vector<const SampledBody*>& known);

/// Things that are allowed and likely to disappoint: settings without effect, bodies that overlap
/// one another or the walls at the start, spacing against support radius, motion that is too fast
/// for the step, stiffness, damping, viscosity and speed of sound against the step, and an estimate
/// of run time and memory that is high. The scene must be without errors.
std::vector<Warning> find_warnings(const Scene& scene);

}  // namespace vat
