#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "server/storage/sqlite/main_database.h"
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

struct SavedScene {
  SavedSceneEntry entry;
  std::string address;                 ///< address of the participant
  std::array<std::uint8_t, 32> key{};  ///< hash of the key for replacement and deletion
  std::string scene;                   ///< JSON text
};

/// Greatest numbers and sizes [bytes] of saved scenes.
struct SavedSceneLimits {
  std::size_t per_address = 0;
  std::size_t bytes_per_address = 0;
  std::size_t in_all = 0;
  std::size_t bytes_in_all = 0;
};

/// Store of scenes saved by users. Thread-safe. Functions throw StorageError.
class SavedScenes {
 public:
  explicit SavedScenes(std::shared_ptr<MainDatabase> main) : main_(std::move(main)) {}

  /// Writes or replaces the scene with this name. Returns the limit that would be exceeded, if any.
  std::optional<LimitExcess> write(const SavedScene& scene, const SavedSceneLimits& limits);
  /// Returns the entries in alphabetical order of names.
  std::vector<SavedSceneEntry> list();
  std::optional<SavedScene> find(const std::string& name);
  void remove(const std::string& name);

 private:
  std::optional<LimitExcess> find_excess(const SavedScene& scene, const SavedSceneLimits& limits);

  const std::shared_ptr<MainDatabase> main_;
};

}  // namespace vat
