#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "core/scene/scene.h"
#include "core/support/names.h"
#include "core/support/result.h"

namespace vat {

/// Level of detail of a scene: the same physics with another distance of particles.
enum class Level : std::uint8_t { coarse = 0, normal = 1, fine = 2, finest = 3 };
template <>
inline constexpr std::array kNamesOf<Level>{"coarse", "normal", "fine", "finest"};
inline constexpr std::size_t kLevelCount = kNamesOf<Level>.size();

/// Returns the distance of particles at a level, relative to that of the scene file.
Real spacing_factor(Level level);

/// Returns `scene`, which is at the level normal, at another level. protocol/SCENE.md describes the
/// rule. The name of the result ends in "@" and the level, except for normal. Fails with the code
/// "not_scalable" and the path of the member for a scene whose particles do not follow from shapes.
/// The result must be validated, as a scene of a file.
Result<Scene> at_level(Scene scene, Level level);

/// The name and the level of a scene, from the name of a result of at_level().
struct LevelledName {
  std::string_view scene;
  Level level = Level::normal;
};
LevelledName split_level(std::string_view name);

/// Returns the level with this name.
std::optional<Level> find_level(std::string_view name);

}  // namespace vat
