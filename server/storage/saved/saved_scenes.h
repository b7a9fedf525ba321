#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "server/support/limit_excess.h"

namespace vat {

/// List entry of a saved scene.
struct SavedSceneEntry {
  std::string name;
  std::string title;
  std::string description;
  std::string saved_by;  ///< name of a participant
  double time = 0;       ///< [s since 1970]
  std::size_t bytes = 0;
};

using SceneKey = std::array<std::uint8_t, 32>;  ///< hash of the key for replacement and deletion

struct SavedScene {
  SavedSceneEntry entry;
  std::string address;  ///< address of the participant
  SceneKey key{};
  std::string scene;  ///< JSON text
};

/// Greatest numbers and sizes [bytes] of saved scenes.
struct SavedSceneLimits {
  std::size_t per_address = 0;
  std::size_t bytes_per_address = 0;
  std::size_t in_all = 0;
  std::size_t bytes_in_all = 0;
};

/// Numbers and sizes [bytes] of saved scenes.
struct SavedSceneUse {
  std::size_t of_address = 0;
  std::size_t bytes_of_address = 0;
  std::size_t in_all = 0;
  std::size_t bytes_in_all = 0;
};

/// Returns the limit that the store would exceed with a further scene of this size, if any.
std::optional<LimitExcess> find_excess(const SavedSceneUse& use, std::size_t bytes,
                                       const SavedSceneLimits& limits);

enum class SceneChange {
  added,
  replaced,
  removed,
  refused,  ///< the scene may not be changed
  absent    ///< no scene has the name
};

/// Store of scenes saved by users. Thread-safe. Functions wait, and throw StorageError.
class SavedScenes {
 public:
  /// Returns whether the user may replace or remove the scene with this key.
  using MayChange = std::function<bool(const SceneKey&)>;

  SavedScenes() = default;
  virtual ~SavedScenes() = default;
  SavedScenes(const SavedScenes&) = delete;
  SavedScenes& operator=(const SavedScenes&) = delete;

  /// Adds the scene, or replaces the scene with this name, whose address and key remain. Returns
  /// `added`, `replaced`, `refused`, or the limit that would be exceeded.
  virtual std::variant<SceneChange, LimitExcess> write(SavedScene scene,
                                                       const SavedSceneLimits& limits,
                                                       const MayChange& may_change) = 0;
  /// Returns the entries in alphabetical order of names.
  virtual std::vector<SavedSceneEntry> list() = 0;
  virtual std::optional<SavedScene> find(const std::string& name) = 0;
  /// Removes a scene. Returns `removed`, `refused` or `absent`.
  virtual SceneChange remove(const std::string& name, const MayChange& may_change) = 0;
};

}  // namespace vat
