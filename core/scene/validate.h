#pragma once

#include <string>
#include <vector>

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
/// whole number of steps, and the limits of core/limits.h.
Errors find_errors(const Scene& scene);

/// The errors of one body to be added to a scene without errors; paths start with `path`.
Errors find_body_errors(const Scene& scene, const BodyDescription& body, const std::string& path);

/// Things that are allowed and likely to disappoint: bodies that overlap one another or the walls
/// at the start, spacing against support radius, and stiffness, viscosity and speed of sound
/// against the step. The scene must be without errors.
std::vector<Warning> find_warnings(const Scene& scene);

}  // namespace vat
