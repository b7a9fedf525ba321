#pragma once

#include <string>
#include <vector>

#include "core/scene/scene.h"
#include "core/support/result.h"
#include "protocol/scene/level.h"

namespace vat {

/// Help text of an argument for load_scene().
inline constexpr const char* kSceneHelp =
    "A scene file (a path with '/' or ending in '.json') or the name of a scene of the catalogue";

/// Returns the scene of a file, or the scene with this name in the catalogue of `scenes_folder`, at
/// a level of detail.
Result<Scene> load_scene(const std::string& argument, const std::string& scenes_folder,
                         Level level = Level::normal);

/// Returns the path of the file that load_scene() reads.
std::string scene_file(const std::string& argument, const std::string& scenes_folder);

/// Returns the sorted names of the catalogue, or an error if the folder cannot be read.
Result<std::vector<std::string>> catalogue_names(const std::string& scenes_folder);

}  // namespace vat
