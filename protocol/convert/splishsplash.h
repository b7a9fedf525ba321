#pragma once

#include <string>
#include <vector>

#include "core/support/result.h"
#include "protocol/scene/scene_json.h"

namespace vat {

/// Limits of the JSON text of a SPlisHSPlasH scene.
inline constexpr JsonLimits kSplishsplashLimits{4 * 1024 * 1024, 32, 1'000'000};

/// Member of the converted file that the scene does not contain.
struct Omission {
  std::string path;  ///< JSON pointer into the converted file
  std::string reason;
};

struct ConvertedScene {
  Json document;  ///< a valid scene of the format vat.scene/1
  std::vector<Omission> omissions;
};

/// Converts a SPlisHSPlasH scene. `meshes` returns the geometry files of the scene. The y axis of
/// the source becomes the z axis.
///
/// - A block, or a model of an .obj file, becomes a liquid body. A material with elasticity makes
///   it a deformable body.
/// - A box around the blocks becomes the vat. Other static bodies become fixed rigid bodies.
///   Dynamic bodies become rigid bodies.
/// - An emitter becomes an emitter of the first body with its material. Without such a body, the
///   scene gets a body of one particle.
///
/// Paths of errors are JSON pointers into the converted file.
Result<ConvertedScene> convert_splishsplash(const Json& document, const MeshSource& meshes);

/// Returns a scene as text with indentation, in which each list of numbers is on one line.
std::string scene_text(const Json& document);

}  // namespace vat
