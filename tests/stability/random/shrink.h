#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>

#include "core/scene/scene.h"
#include "core/support/result.h"

namespace vat::stability {

/// The smallest scene that was found for which `fails` holds, starting from one for which it does:
/// bodies, interfaces, motions and gravity are left out and sizes halved for as long as it still
/// fails, at most `tries` times.
Scene shrink(const Scene& scene, const std::function<bool(const Scene&)>& fails, int tries = 200);

/// Writes the scene as a file that every command takes.
Status write_scene_file(const Scene& scene, const std::filesystem::path& file);

}  // namespace vat::stability
