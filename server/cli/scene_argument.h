#pragma once

#include <string>
#include <vector>

#include "core/scene/scene.h"
#include "core/support/result.h"

namespace vat {

/// Help text for an argument that load_scene() takes.
inline constexpr const char* kSceneHelp =
    "A scene file (a path with '/' or ending in '.json') or the name of a scene of the catalogue";

/// Loads the scene that a user names: a file, or the scene of the catalogue in `scenes_folder`.
Result<Scene> load_scene(const std::string& argument, const std::string& scenes_folder);

/// Names of the scenes of the catalogue in order; fails where the folder cannot be read.
Result<std::vector<std::string>> catalogue_names(const std::string& scenes_folder);

}  // namespace vat
