#pragma once

#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "server/cluster/saved/saved_store.h"
#include "server/storage/saved/saved_scenes.h"

namespace vat {

/// Scenes that users of a cluster saved. Each node has the same list.
class ClusterScenes final : public SavedScenes {
 public:
  /// `store` must outlive the scenes.
  explicit ClusterScenes(SavedStore& store) : store_(store) {}

  std::variant<SceneChange, LimitExcess> write(SavedScene scene, const SavedSceneLimits& limits,
                                               const MayChange& may_change) override;
  std::vector<SavedSceneEntry> list() override;
  std::optional<SavedScene> find(const std::string& name) override;
  SceneChange remove(const std::string& name, const MayChange& may_change) override;

 private:
  SavedStore& store_;
};

}  // namespace vat
