#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "server/storage/main_database.h"
#include "server/storage/saved_excess.h"

namespace vat {

/// A scene that somebody has saved, as it is listed.
struct SavedSceneEntry {
  std::string name;
  std::string title;
  std::string description;
  std::string saved_by;  ///< the name of a person
  double time = 0;       ///< [s] since 1970
  std::size_t bytes = 0;
};

struct SavedScene {
  SavedSceneEntry entry;
  std::string address;                 ///< of who has saved it
  std::array<std::uint8_t, 32> key{};  ///< hash of what is shown to replace or delete it
  std::string scene;                   ///< JSON
};

/// How many scenes are kept, and how large they are together.
struct SavedSceneLimits {
  std::size_t per_address = 0;
  std::size_t bytes_per_address = 0;
  std::size_t in_all = 0;
  std::size_t bytes_in_all = 0;
};

/// The scenes that users have saved. Safe to use from any thread; throws StorageError.
class SavedScenes {
 public:
  explicit SavedScenes(std::shared_ptr<MainDatabase> main) : main_(std::move(main)) {}

  /// Keeps it, in place of one of its name if there is one; or tells what stands in the way.
  std::optional<SavedExcess> write(const SavedScene& scene, const SavedSceneLimits& limits);
  /// In the order of their names.
  std::vector<SavedSceneEntry> list();
  std::optional<SavedScene> find(const std::string& name);
  void remove(const std::string& name);

 private:
  std::optional<SavedExcess> find_excess(const SavedScene& scene, const SavedSceneLimits& limits);

  const std::shared_ptr<MainDatabase> main_;
};

}  // namespace vat
