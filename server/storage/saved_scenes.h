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
  double time = 0;       ///< [s] since 1970
  std::size_t bytes = 0;
};

struct SavedScene {
  SavedSceneEntry entry;
  std::string address;                 ///< of the participant
  std::array<std::uint8_t, 32> key{};  ///< hash of the key for replacing or deleting it
  std::string scene;                   ///< JSON
};

/// Greatest numbers and sizes of saved scenes.
struct SavedSceneLimits {
  std::size_t per_address = 0;
  std::size_t bytes_per_address = 0;
  std::size_t in_all = 0;
  std::size_t bytes_in_all = 0;
};

/// Scenes that users have saved. Safe to use from any thread; throws StorageError.
class SavedScenes {
 public:
  explicit SavedScenes(std::shared_ptr<MainDatabase> main) : main_(std::move(main)) {}

  /// Writes or replaces the scene of this name. Returns the limit if it would be exceeded.
  std::optional<LimitExcess> write(const SavedScene& scene, const SavedSceneLimits& limits);
  /// In alphabetical order of names.
  std::vector<SavedSceneEntry> list();
  std::optional<SavedScene> find(const std::string& name);
  void remove(const std::string& name);

 private:
  std::optional<LimitExcess> find_excess(const SavedScene& scene, const SavedSceneLimits& limits);

  const std::shared_ptr<MainDatabase> main_;
};

}  // namespace vat
