#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>

#include "core/scene/scene.h"
#include "core/support/result.h"

namespace vat::stability {

/// Returns the smallest scene found for which `fails` is true, starting with a scene for which it
/// is true. Removes bodies, interfaces, motions and gravity, and halves sizes, in at most `tries`
/// attempts.
Scene shrink(const Scene& scene, const std::function<bool(const Scene&)>& fails, int tries = 200);

/// Writes the scene as a file that every command accepts.
Status write_scene_file(const Scene& scene, const std::filesystem::path& file);

}  // namespace vat::stability
