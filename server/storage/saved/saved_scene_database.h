#pragma once

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "server/storage/saved/saved_scenes.h"
#include "server/storage/sqlite/main_database.h"

namespace vat {

/// Saved scenes in the main database of a data folder.
class SavedSceneDatabase final : public SavedScenes {
 public:
  explicit SavedSceneDatabase(std::shared_ptr<MainDatabase> main) : main_(std::move(main)) {}

  std::variant<SceneChange, LimitExcess> write(SavedScene scene, const SavedSceneLimits& limits,
                                               const MayChange& may_change) override;
  std::vector<SavedSceneEntry> list() override;
  std::optional<SavedScene> find(const std::string& name) override;
  SceneChange remove(const std::string& name, const MayChange& may_change) override;

 private:
  struct Owner {
    std::string address;
    SceneKey key{};
  };
  std::optional<Owner> find_owner(const std::string& name);
  /// Returns the use by all scenes except the one with this name.
  SavedSceneUse use_without(const std::string& name, const std::string& address);

  const std::shared_ptr<MainDatabase> main_;
};

}  // namespace vat
